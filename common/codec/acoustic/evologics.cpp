#include "codec/acoustic/evologics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "codec/framer.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr std::string_view kPrefix = "+++AT";
constexpr std::string_view kPlain = "USBL";
constexpr std::string_view kFix = "USBLLONG,";
constexpr std::size_t kLongestCommand = 64;  // that a line answers, between the prefix and the length
constexpr std::size_t kLongestText = 2'048;  // a payload of 1,024 bytes and what is said of it
constexpr std::size_t kLongestPlain = 256;
constexpr std::size_t kLengthDigits = 4;

constexpr double kFarthest_m = 100'000.0;
constexpr double kHighestAddress = 254.0;
constexpr double kOldest_s = 600.0;
constexpr double kLongestTravel_us = 70e6;
constexpr double kTurn = 6.2832;  // rad, as four decimals write it

/// Whether one of both begins with the other.
bool may_become(std::string_view front, std::string_view word) {
  const std::size_t common = std::min(front.size(), word.size());
  return front.substr(0, common) == word.substr(0, common);
}

double norm(const std::array<double, 3>& r) {
  return std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
}

bool all_within(const std::array<double, 3>& r, double limit) {
  return std::all_of(r.begin(), r.end(), [limit](double one) { return std::abs(one) <= limit; });
}

/// What stands behind the first word of a fix.
class UsblLong {
 public:
  enum Column : std::size_t {
    kSent = 0,
    kMeasured = 1,
    kAddress = 2,
    kAlongHead = 3,
    kAlongEast = 6,
    kAngles = 9,
    kTravel = 12,
    kStrength = 13,
    kIntegrity = 14,
    kAccuracy = 15,
    kColumns = 16,
  };

  [[nodiscard]] std::optional<RejectReason> parse(std::string_view rest) {
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::size_t comma = rest.find(',');
      if ((comma == std::string_view::npos) != (i + 1 == kColumns)) return RejectReason::structure;
      const std::string_view column = rest.substr(0, comma);
      const std::optional<double> number = parse_decimal(column);
      if (!number) return RejectReason::field;
      value_[i] = *number;
      if (i == kAddress) address_ = column;
      if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
    }
    return refused();
  }

  [[nodiscard]] double value(Column column) const { return value_[column]; }
  [[nodiscard]] std::array<double, 3> three(Column first) const {
    return {value_[first], value_[first + 1], value_[first + 2]};
  }
  [[nodiscard]] std::string_view address() const { return address_; }
  [[nodiscard]] double age_s() const { return value_[kSent] - value_[kMeasured]; }

 private:
  [[nodiscard]] std::optional<RejectReason> refused() const {
    const auto within = [this](Column column, double low, double high) {
      return value_[column] >= low && value_[column] <= high;
    };
    if (!parse_digits(address_)) return RejectReason::field;
    const bool possible = age_s() >= 0.0 && age_s() <= kOldest_s && within(kAddress, 1.0, kHighestAddress) &&
                          all_within(three(kAlongHead), kFarthest_m) &&
                          all_within(three(kAlongEast), kFarthest_m) && all_within(three(kAngles), kTurn) &&
                          within(kTravel, 0.0, kLongestTravel_us) && within(kAccuracy, 0.0, kFarthest_m);
    if (!possible) return RejectReason::out_of_range;
    // One path, told along two sets of axes with four decimals.
    const double along_head_m = norm(three(kAlongHead));
    const double apart_m = std::abs(along_head_m - norm(three(kAlongEast)));
    if (apart_m > 1e-3 + 1e-3 * along_head_m) return RejectReason::structure;
    return std::nullopt;
  }

  std::array<double, kColumns> value_{};
  std::string_view address_;
};

class Evologics final : public Framer {
 public:
  explicit Evologics(const CodecOptions& options)
      : Framer(kPrefix.size() + kLongestCommand + kLengthDigits + kLongestText + 4,
               LineEnds::belong_to_frames),
        usbl_(options.usbl),
        beacons_(options.beacons) {}

 protected:
  [[nodiscard]] Probe probe(Bytes front) const override {
    const std::string_view text = text_of(front);
    if (may_become(text, kPrefix)) return text.size() < kPrefix.size() ? Probe::maybe() : counted(text);
    if (may_become(text, kPlain)) return text.size() < kPlain.size() ? Probe::maybe() : plain(text);
    return Probe::skip(std::min(text.find_first_of("+U", 1), text.size()));
  }

  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) override {
    std::string_view text = text_of(frame);
    if (text.starts_with(kPrefix)) {
      text.remove_prefix(text.find(':') + 1);  // the command, if any
      text.remove_prefix(text.find(':') + 1);  // the length
    }
    if (!text.starts_with(kFix)) return Outcome::ignored();
    if (is_line_end(text.back())) return Outcome::refused(RejectReason::length);  // it lost a byte
    UsblLong fix;
    if (const auto reason = fix.parse(text.substr(kFix.size()))) return Outcome::refused(*reason);
    deliver(fix, frame.size(), offset, sink);
    return Outcome::used();
  }

 private:
  /// `+++AT`, a command or nothing, `:`, a length, `:`, as many bytes, and a line end.
  [[nodiscard]] static Probe counted(std::string_view text) {
    std::size_t at = kPrefix.size();
    for (; at < text.size() && text[at] != ':'; ++at) {
      if (text[at] < ' ' || text[at] > '~' || at == kPrefix.size() + kLongestCommand) return Probe::skip(1);
    }
    if (at == text.size()) return Probe::need();
    const std::size_t digits = ++at;
    std::size_t size = 0;
    for (; at < text.size() && text[at] != ':'; ++at) {
      if (!is_digit(text[at]) || at == digits + kLengthDigits) return Probe::skip(1);
      size = 10 * size + static_cast<std::size_t>(text[at] - '0');
    }
    if (at == text.size()) return Probe::need();
    if (at == digits) return Probe::skip(1);
    const std::size_t begin = at + 1;
    const std::size_t end = begin + size;
    if (size > kLongestText) return miscounted(text, begin, begin + kLongestPlain);
    if (text.size() <= end) return Probe::need(end + 1);
    if (is_line_end(text[end])) return Probe::frame(end);
    return miscounted(text, begin, end);
  }

  /// A line whose count does not hold. What follows may be whole: the next line, or what begins where this
  /// one breaks off.
  [[nodiscard]] static Probe miscounted(std::string_view text, std::size_t begin, std::size_t end) {
    const std::string_view told = text.substr(0, end);
    const std::size_t tail = end - std::min(end - begin, kPrefix.size() - 1);  // a prefix may begin here
    const std::size_t broken = std::min({told.find_first_of("\r\n", begin), told.find(kPrefix, begin), tail});
    if (broken == tail && told.size() < end) return Probe::need(end);
    return Probe::bad(RejectReason::length, broken, broken);
  }

  [[nodiscard]] static Probe plain(std::string_view text) {
    for (std::size_t i = kPlain.size(); i < text.size(); ++i) {
      if (is_line_end(text[i])) return Probe::frame(i);
      if (text[i] < ' ' || text[i] > '~') return Probe::bad(RejectReason::structure, i);
      if (text.substr(0, i + 1).ends_with(kPrefix)) {
        return Probe::bad(RejectReason::structure, i + 1 - kPrefix.size(), i + 1 - kPrefix.size());
      }
      if (i == kLongestPlain) return Probe::bad(RejectReason::length, i);
    }
    return Probe::need();
  }

  void deliver(const UsblLong& fix, std::size_t frame_size, std::uint64_t offset, Sink& sink) {
    UsblSample sample;
    sample.transponder = fix.address();
    sample.travel_time_s = fix.value(UsblLong::kTravel) * 1e-6;
    const double accuracy_m = fix.value(UsblLong::kAccuracy);
    if (accuracy_m > 0.0) sample.sigma_m = std::max(accuracy_m, usbl_.sigma_floor_m);
    if (usbl_.carrier == UsblCarrier::vehicle) {
      const auto [forward_m, left_m, up_m] = fix.three(UsblLong::kAlongHead);
      sample.frame = UsblFrame::vehicle_frd;
      sample.relative_m = {forward_m, -left_m, -up_m};
      place(sample);
    } else {
      const auto [east_m, north_m, up_m] = fix.three(UsblLong::kAlongEast);
      sample.frame = UsblFrame::ned;
      sample.relative_m = {north_m, east_m, -up_m};
    }
    DeviceTime time;
    time.age_ns = from_seconds(fix.age_s());
    emit(sink, sample, time, offset, frame_size);
  }

  /// Where the beacon is, if anybody has said so.
  void place(UsblSample& sample) const {
    const BeaconPlace* beacon = beacons_.find(sample.transponder.view());
    if (beacon == nullptr) return;
    sample.station_latitude_rad = beacon->latitude_rad;
    sample.station_longitude_rad = beacon->longitude_rad;
    sample.station_depth_m = beacon->depth_m;
  }

  UsblOptions usbl_;
  BeaconOptions beacons_;
};

}  // namespace

std::unique_ptr<Codec> make_evologics(const CodecOptions& options) {
  return std::make_unique<Evologics>(options);
}

}  // namespace fathom::codec
