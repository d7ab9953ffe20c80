#include "codec/altimeter/ping.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "base/bytes/little_endian.hpp"
#include "codec/altimeter/deepest.hpp"
#include "codec/byte_sum.hpp"
#include "codec/framer.hpp"

namespace fathom::codec {

namespace ping {

namespace {

constexpr std::size_t kHeader = 8;
constexpr std::size_t kSum = 2;

constexpr double kMillimetresPerMetre = 1e3;
constexpr double kSurest_percent = 100.0;

/// So many other messages behind one that numbers its pings distance_simple counts again.
constexpr int kForgotten = 50;

/// A message that tells a range.
struct Layout {
  std::uint16_t identifier;
  std::size_t length;  ///< of the contents, before what `element` counts
  /// Where the count of what follows stands, and the size of each; 0: nothing follows.
  std::size_t count_at;
  std::size_t element;
  std::size_t range_at;
  bool range_is_mm;  ///< else a float in metres
  std::size_t confidence_at;
  std::size_t confidence_bytes;
  std::optional<std::size_t> number_at;  ///< of the ping
};
constexpr std::array<Layout, 5> kLayouts{{{1211, 5, 0, 0, 0, true, 4, 1, std::nullopt},
                                          {1212, 24, 0, 0, 0, true, 4, 2, 8},
                                          {1300, 26, 24, 1, 0, true, 4, 2, 8},
                                          {1223, 16, 0, 0, 0, true, 10, 1, 12},
                                          {1308, 66, 64, 2, 48, false, 60, 1, 0}}};

const Layout* find_layout(std::uint16_t identifier) {
  for (const Layout& layout : kLayouts) {
    if (layout.identifier == identifier) return &layout;
  }
  return nullptr;
}

/// What no contents exceed: those of the longest profile, and what other devices of the family send.
constexpr std::size_t kMostElements = 8192;
constexpr std::size_t kLongestOther = 2048;
std::size_t longest(std::uint16_t identifier) {
  const Layout* layout = find_layout(identifier);
  return layout == nullptr ? kLongestOther : layout->length + layout->element * kMostElements;
}
constexpr std::size_t kMostOfMessage =
    kHeader + kLayouts.back().length + kLayouts.back().element * kMostElements + kSum;

struct Told {
  double range_m = 0.0;
  double confidence_percent = 0.0;
};

class Decoder final : public Framer {
 public:
  explicit Decoder(const CodecOptions& options)
      : Framer(kMostOfMessage), least_confidence_percent_(options.least_confidence_percent) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override {
    if (const auto seek = seek_sync(front, 'B', 'R')) return *seek;
    if (front.size() < kHeader) return Probe::need(kHeader);
    const std::size_t contents = load_le<std::uint16_t>(front, 2);
    if (contents > longest(load_le<std::uint16_t>(front, 4)))
      return Probe::bad(RejectReason::length, kHeader);
    const std::size_t total = kHeader + contents + kSum;
    if (front.size() < total) return Probe::need(total);
    if (byte_sum(front.first(total - kSum)) != load_le<std::uint16_t>(front, total - kSum))
      return Probe::bad(RejectReason::checksum, total);
    return Probe::frame(total);
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    ++since_numbered_;
    const Layout* layout = find_layout(load_le<std::uint16_t>(frame, 4));
    if (layout == nullptr) return Outcome::ignored();
    const Bytes contents = frame.subspan(kHeader, frame.size() - kHeader - kSum);
    if (!fits(*layout, contents)) return Outcome::refused(RejectReason::structure);
    Told told;
    if (const auto reason = read(*layout, contents, told)) return Outcome::refused(*reason);
    if (was_told(*layout, contents)) return Outcome::ignored();
    AltimeterSample sample;
    if (told.confidence_percent >= least_confidence_percent_) sample.altitude_m = told.range_m;
    emit(sink, sample, {}, offset, frame.size());
    return Outcome::used();
  }

 private:
  static bool fits(const Layout& layout, Bytes contents) {
    if (contents.size() < layout.length) return false;
    const std::size_t count = layout.element == 0 ? 0 : load_le<std::uint16_t>(contents, layout.count_at);
    return contents.size() == layout.length + layout.element * count;
  }

  static std::optional<RejectReason> read(const Layout& layout, Bytes contents, Told& told) {
    told.range_m = layout.range_is_mm
                       ? load_le<std::uint32_t>(contents, layout.range_at) / kMillimetresPerMetre
                       : static_cast<double>(load_le<float>(contents, layout.range_at));
    if (!std::isfinite(told.range_m)) return RejectReason::field;
    told.confidence_percent = layout.confidence_bytes == 1
                                  ? contents[layout.confidence_at]
                                  : load_le<std::uint16_t>(contents, layout.confidence_at);
    if (told.range_m < 0.0 || told.range_m > kDeepestBottom_m || told.confidence_percent > kSurest_percent)
      return RejectReason::out_of_range;
    return std::nullopt;
  }

  bool was_told(const Layout& layout, Bytes contents) {
    if (!layout.number_at) return last_number_ && since_numbered_ <= kForgotten;
    const auto number = load_le<std::uint32_t>(contents, *layout.number_at);
    if (last_number_ == number) return true;
    last_number_ = number;
    since_numbered_ = 0;
    return false;
  }

  double least_confidence_percent_;
  std::optional<std::uint32_t> last_number_;
  int since_numbered_ = 0;  ///< messages behind the last ping that has a number
};

}  // namespace
}  // namespace ping

constinit const std::string_view kPingGreeting{"BR\x02\x00\x78\x05\x00\x00\x14\x05\x2C\x01", 12};

std::unique_ptr<Codec> make_ping(const CodecOptions& options) {
  return std::make_unique<ping::Decoder>(options);
}

}  // namespace fathom::codec
