#include "cli/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace fathom::cli {
namespace {

constexpr DurationNs kRedraw_ns = 100 * kNsPerMillisecond;
constexpr int kWidth = 40;

}  // namespace

Progress::Progress(std::string label, std::uint64_t total)
    : label_(std::move(label)),
      total_(total),
      terminal_(total > 0 && isatty(STDERR_FILENO) == 1),
      started_ns_(clock_.monotonic_ns()),
      last_draw_ns_(started_ns_) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::update(std::uint64_t done) {
  if (!terminal_) return;
  const TimeNs now_ns = clock_.monotonic_ns();
  if (now_ns - last_draw_ns_ < kRedraw_ns) return;
  last_draw_ns_ = now_ns;
  drawn_ = true;
  const double share = std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
  const int filled = static_cast<int>(share * kWidth);
  const double left_s = share > 0.0 ? to_seconds(now_ns - started_ns_) * (1.0 - share) / share : 0.0;
  std::fprintf(stderr, "\r%s [%s%s] %3.0f %%, %.0f s left\033[K", label_.c_str(),
               std::string(static_cast<std::size_t>(filled), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), 100.0 * share, left_s);
  std::fflush(stderr);
}

}  // namespace fathom::cli
