#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "samples/status/health.hpp"

namespace fathom::health {

/// The processes that speak as one service. A restart replaces one by another; two that live take turns.
class ServiceVoices {
 public:
  /// `now_ns` is monotonic. True: this process spoke for the first time.
  bool hear(const ServiceStatus& status, TimeNs now_ns);
  /// Leaves out who has been silent for longer than `after_s`. The last one stays, so that a restart is
  /// noticed after any silence.
  void forget(TimeNs now_ns, double after_s);

  /// Whether two or more live at the same time.
  [[nodiscard]] bool several() const;
  [[nodiscard]] std::size_t count() const { return voices_.size(); }
  /// Of the one that spoke last; 0 before anybody did.
  [[nodiscard]] std::uint32_t newest_pid() const { return voices_.empty() ? 0 : voices_.back().pid; }
  /// Names the two that spoke last, by process and host; for several() only.
  [[nodiscard]] std::string sentence_about(const char* service) const;

 private:
  struct Voice {
    std::uint32_t pid = 0;
    TimeNs started_ns = 0;
    std::string host{};
    TimeNs heard_ns = 0;  ///< monotonic
  };
  std::vector<Voice> voices_{};  ///< the newest last
  int returns_ = 0;              ///< how often one spoke again after another had, while there are several
};

}  // namespace fathom::health
