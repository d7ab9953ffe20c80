#include "health/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

namespace fathom::health {

std::string sentence(const char* format, ...) {
  std::array<char, 240> text{};  // the wire's bound on an alarm's text is 255 bytes
  va_list arguments;
  va_start(arguments, format);
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is just above, the analyser misses it
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return text.data();
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "an unknown time";
  if (seconds < 100.0) return sentence("%.1f s", seconds);
  const auto whole = static_cast<long long>(std::min(seconds, 1e12));
  if (whole < 3600) return sentence("%lld min %02lld s", whole / 60, whole % 60);
  return sentence("%lld h %02lld min", whole / 3600, whole % 3600 / 60);
}

Name alarm_key(std::string_view kind, std::string_view name) {
  std::string key(kind);
  key += ':';
  if (key.size() + name.size() <= Name::kCapacity) return Name(key.append(name));
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  const std::size_t head = Name::kCapacity > key.size() + 3 ? Name::kCapacity - key.size() - 3 : 0;
  key.append(name.substr(0, head));
  return Name(key + sentence("~%02x", hash >> 24U));
}

}  // namespace fathom::health
