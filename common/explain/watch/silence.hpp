#pragma once

#include <string>
#include <vector>

#include "explain/history.hpp"

namespace fathom::explain {

/// A time in which nothing of an instrument arrived, by its samples and not by what fusion said of them.
struct Silence {
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
  bool to_end = false;       ///< it goes on to the end of the history
  DurationNs stamps_ns = 0;  ///< by how much the stamps stepped over it
  [[nodiscard]] DurationNs length_ns() const { return end_ns - begin_ns; }
};

/// Those that last so long or longer, in order. An instrument that ends with the mission is not silent.
[[nodiscard]] std::vector<Silence> silences(const History& history, const Stream& stream,
                                            DurationNs least_ns);

/// What its bridge last said of an instrument in a time, "gps_bridge said: ..."; empty: nothing.
[[nodiscard]] std::string bridge_said(const History& history, const std::string& sensor, TimeNs from_ns,
                                      TimeNs to_ns);

/// Whether the last life sign of a service says that it goes on; false also where there is none.
[[nodiscard]] bool goes_on(const History& history, const std::string& service);

}  // namespace fathom::explain
