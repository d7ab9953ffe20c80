#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "bus/participant.hpp"
#include "bus/writer.hpp"
#include "samples/command.hpp"
#include "samples/position/fix.hpp"

namespace fathom {

/// Gives orders and tells positions. Its writers are made at first use. Thread-safe.
class OrderGiver {
 public:
  /// The header of what is said now: vehicle and times; nothing while no vehicle is known.
  using Now = std::function<std::optional<SampleHeader>()>;

  /// The participant outlives this. `name`: who orders.
  OrderGiver(bus::Participant& participant, std::string name, Now now)
      : participant_(participant), name_(std::move(name)), now_(std::move(now)) {}

  /// As Client::order() and Client::tell().
  void order(Command command, double timeout_s);
  void tell(FixSample fix, double timeout_s);

 private:
  template <class Sample>
  SampleHeader meet(std::optional<bus::Writer<Sample>>& writer, const char* what, double timeout_s);

  bus::Participant& participant_;
  const std::string name_;
  const Now now_;
  std::mutex mutex_;  // of what follows
  std::uint64_t sequence_ = 0;
  std::optional<bus::Writer<Command>> commands_;
  std::optional<bus::Writer<FixSample>> fixes_;
};

}  // namespace fathom
