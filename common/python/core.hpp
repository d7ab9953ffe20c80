#pragma once

#include <memory>

#include <fathom/client.hpp>
#include <sys/types.h>

#include "python/kit.hpp"

namespace fathom::python {

/// The client as Python holds it, with the rules of Python's threads: what may wait gives up the
/// interpreter's lock and hears Ctrl-C, and no thread of the bus ever asks for that lock. Handlers are called
/// by a thread of Python that asks next_event(). All functions need the interpreter's lock.
class Core {
 public:
  Core(const ClientOptions& options, std::shared_ptr<const Clock> clock);
  ~Core();
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  [[nodiscard]] std::optional<NavState> latest() const;
  [[nodiscard]] double age_s() const;
  [[nodiscard]] NavHealth health() const;
  [[nodiscard]] std::optional<AlignmentStatus> alignment() const;
  [[nodiscard]] std::optional<MonitorStatus> monitor() const;
  void publish_route(const Route& route);
  [[nodiscard]] std::optional<NavState> wait_next(double timeout_s);
  void order(const Command& command, double timeout_s);
  void tell(const FixSample& fix, double timeout_s);

  /// Whether states, and alarms, are kept for next_event().
  void hear_states(bool wanted);
  void hear_alarms(bool wanted);
  /// (topic, value) of the next state or alarm; None once the client is closed.
  [[nodiscard]] py::object next_event();

  /// Leaves the vehicle network. Returns when no call is under way any more. May be called again.
  void close();
  /// Likewise, before the interpreter ends: other threads that wait, or ask again, are kept waiting, since an
  /// exception in them would only be noise.
  void close_at_exit();

 private:
  struct Impl;
  template <class Give>
  void give(const char* what, double timeout_s, Give give);
  class Use;
  void close(bool at_exit);
  [[nodiscard]] bool of_another_process() const;

  pid_t process_;
  Impl* impl_;  ///< owned; left to its fate in a forked process, where the threads that it waits for are not
};

void add_core(py::module_& module);

}  // namespace fathom::python
