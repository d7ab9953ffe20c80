#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "config/doors/nmea_out_config.hpp"

namespace fathom::nmea_out {

struct OutletStatus {
  std::string name;                   ///< "tcp server 127.0.0.1:10110"
  std::string trouble;                ///< why nothing leaves; empty when all is well
  std::uint64_t bytes = 0;            ///< that left
  std::uint64_t dropped = 0;          ///< bytes that a slow receiver did not take
  int clients = 0;                    ///< of a TCP server
  std::uint64_t clients_refused = 0;  ///< because there were as many as there may be
};

/// The way out of sentences, on one thread for all of them. A receiver that is slow, dead or not there loses
/// sentences and holds up nobody: what waits for it is bounded, and only whole texts are left out. A port
/// that fails is opened again, after 0.1 to 5 s, for ever.
class Outlets {
 public:
  /// `say` hears changes between well and trouble, of many the newest (runtime::Reopening), and that clients
  /// are refused, on the outlets' thread.
  using Say = std::function<void(bool is_trouble, const std::string& text)>;

  Outlets(const std::vector<config::NmeaOutputConfig>& outputs, Say say);
  ~Outlets();
  Outlets(const Outlets&) = delete;
  Outlets& operator=(const Outlets&) = delete;

  /// Lets a text leave by output number `index`. Returns at once.
  void send(std::size_t index, std::string text);
  [[nodiscard]] std::vector<OutletStatus> status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::nmea_out
