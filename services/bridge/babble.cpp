#include "bridge/babble.hpp"

#include <algorithm>
#include <cstdio>

namespace fathom::bridge {

std::optional<Babble::Report> Babble::not_understood(std::span<const std::uint8_t> bytes, std::uint64_t waste,
                                                     TimeNs now_ns) {
  if (bytes_ == 0) counted_ns_ = now_ns;
  bytes_ += bytes.size();
  const std::size_t more = std::min(kShown - first_count_, bytes.size());
  std::copy_n(bytes.begin(), more, first_.begin() + static_cast<std::ptrdiff_t>(first_count_));
  first_count_ += more;
  // What is the beginning of a frame may yet become one.
  if (waste == 0) return std::nullopt;
  if (!since_ns_) since_ns_ = now_ns;
  if (now_ns - *since_ns_ < after_ns_ || (said_ns_ && now_ns - *said_ns_ < kAgain_ns)) return std::nullopt;
  Report out{bytes_, to_seconds(now_ns - counted_ns_), {}};
  for (std::size_t i = 0; i < first_count_; ++i) {
    std::array<char, 4> text{};
    std::snprintf(text.data(), text.size(), i == 0 ? "%02x" : " %02x", unsigned{first_[i]});
    out.first_bytes += text.data();
  }
  said_ns_ = now_ns;
  bytes_ = 0;
  first_count_ = 0;
  return out;
}

bool Babble::understood() {
  const bool was_said = said_ns_.has_value();
  forget();
  said_ns_.reset();
  return was_said;
}

void Babble::forget() {
  since_ns_.reset();
  bytes_ = 0;
  first_count_ = 0;
}

}  // namespace fathom::bridge
