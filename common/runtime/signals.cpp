#include "runtime/signals.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <system_error>

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace fathom::runtime {
namespace {

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

void block_stop_signals() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // NOLINT(cert-err33-c): SIG_IGN for SIGPIPE cannot fail
}

StopSignal::StopSignal() {
  const sigset_t set = stop_signals();
  signals_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (signals_ < 0 || wake_ < 0) {
    const int error = errno;
    if (signals_ >= 0) close(signals_);
    if (wake_ >= 0) close(wake_);
    throw std::system_error(error, std::generic_category(), "waiting for signals");
  }
}

StopSignal::~StopSignal() {
  close(signals_);
  close(wake_);
}

StopSignal::Woken StopSignal::wait(DurationNs host_ns) {
  std::array<pollfd, 2> watched{{{signals_, POLLIN, 0}, {wake_, POLLIN, 0}}};
  const DurationNs bounded = host_ns > 0 ? host_ns : 0;
  timespec limit{};
  limit.tv_sec = static_cast<time_t>(bounded / kNsPerSecond);
  limit.tv_nsec = static_cast<long>(bounded % kNsPerSecond);
  if (ppoll(watched.data(), watched.size(), &limit, nullptr) <= 0) return Woken::timeout;
  if ((watched[0].revents & POLLIN) != 0) {
    signalfd_siginfo info{};
    if (read(signals_, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) return Woken::signal;
  }
  std::uint64_t count = 0;
  if (read(wake_, &count, sizeof count) == static_cast<ssize_t>(sizeof count)) return Woken::request;
  return Woken::timeout;
}

void StopSignal::wake() {
  const std::uint64_t one = 1;
  // A full counter already wakes the waiter.
  [[maybe_unused]] const auto written = write(wake_, &one, sizeof one);
}

}  // namespace fathom::runtime
