#pragma once

#include <memory>

#include "bus/participant.hpp"
#include "status/view.hpp"

namespace fathom::cli {

/// Listens to what a vehicle says about itself and keeps the newest of everything.
class StatusListener {
 public:
  /// `vehicle` empty: the first one heard. Throws bus::BusError.
  StatusListener(const bus::ParticipantOptions& options, const std::string& vehicle);
  ~StatusListener();

  /// Enough has been heard for a judgement that will not change with the next second.
  [[nodiscard]] bool complete() const;
  [[nodiscard]] status::StatusView view() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::cli
