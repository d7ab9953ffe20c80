#include "cli/init/recognizer.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <variant>

namespace fathom::cli {
namespace {

// How little of a stream its protocol may explain, and how many samples it takes. Receivers send messages of
// other protocols besides; what any line with a number may be has to explain everything.
struct Demand {
  double share;
  std::uint64_t samples;
};

/// So soon behind the first sample comes what waited with it.
constexpr DurationNs kGathered_ns = 50 * kNsPerMillisecond;

/// The lower, the less likely it is that anything else looks like it. A line of several NMEA sentences is
/// nmea0183 before it is nmea_attitude: a position beside the attitude is not passed over.
int rank_of(std::string_view protocol) {
  if (protocol == "nmea0183" || protocol == "pd6") return 1;
  if (protocol == "nmea_air_data" || protocol == "nmea_attitude" || protocol == "paroscientific") return 2;
  if (protocol.starts_with("ascii_")) return 3;
  return 0;
}

Demand demand_of(int rank) {
  constexpr std::array<Demand, 4> kDemands{{{0.25, 2}, {0.5, 2}, {0.7, 3}, {0.9, 5}}};
  return kDemands[static_cast<std::size_t>(rank)];
}

}  // namespace

struct Recognizer::Listener : codec::Sink {
  struct Kind {
    std::uint64_t samples = 0;
    std::uint64_t last_offset = 0;
    TimeNs first_ns = 0;
    TimeNs last_ns = 0;
    // What had gathered in the line before it was heard comes at once and tells no rate: counted is from its
    // last one on.
    std::uint64_t gathered = 0;
    TimeNs gathered_ns = 0;
  };

  explicit Listener(const codec::Protocol& one) : protocol(&one), decoder(one.make({})) {}

  void on_sample(const codec::Decoded& decoded) override {
    Kind& kind = kinds[source_of(decoded.sample)];
    if (kind.samples == 0) kind.first_ns = now_ns;
    // A frame of a DVL has the ground and the water.
    if (kind.samples == 0 || decoded.offset != kind.last_offset) ++kind.samples;
    kind.last_offset = decoded.offset;
    kind.last_ns = now_ns;
    if (now_ns - kind.first_ns <= kGathered_ns) {
      kind.gathered = kind.samples;
      kind.gathered_ns = now_ns;
    }
    if (const auto* fix = std::get_if<GpsSample>(&decoded.sample)) {
      if (fix->fix != GpsFix::none && known(fix->latitude_rad)) latitude_rad = fix->latitude_rad;
    } else if (const auto* imu = std::get_if<ImuSample>(&decoded.sample)) {
      for (std::size_t i = 0; i < 3; ++i) force_sum[i] += imu->specific_force_B_m_s2[i];
    } else if (const auto* depth = std::get_if<DepthSample>(&decoded.sample)) {
      if (!depth_m) depth_m = depth->depth_m;
    }
  }
  void on_rejected(const codec::Rejected& rejected) override { rejected_bytes += rejected.length; }

  [[nodiscard]] double share() const {
    const codec::Totals totals = decoder->totals();
    if (totals.bytes == 0) return 0.0;
    const std::uint64_t lost = std::min(totals.bytes, totals.skipped_bytes + rejected_bytes);
    return static_cast<double>(totals.bytes - lost) / static_cast<double>(totals.bytes);
  }
  [[nodiscard]] std::uint64_t samples() const {
    std::uint64_t sum = 0;
    for (const auto& [kind, seen] : kinds) sum += seen.samples;
    return sum;
  }

  const codec::Protocol* protocol;
  std::unique_ptr<codec::Codec> decoder;
  TimeNs now_ns = 0;
  std::map<SourceKind, Kind> kinds;
  std::uint64_t rejected_bytes = 0;
  std::optional<double> latitude_rad;
  std::array<double, 3> force_sum{0.0, 0.0, 0.0};
  std::optional<double> depth_m;
};

Recognizer::Recognizer() {
  for (const codec::Protocol& one : codec::protocols()) {
    // A number a line may be anything: that it is a height has to be said.
    if (one.name != "ascii_altitude") listeners_.push_back(std::make_unique<Listener>(one));
  }
}
Recognizer::~Recognizer() = default;

void Recognizer::feed(std::span<const std::uint8_t> bytes, TimeNs arrival_ns) {
  bytes_ += bytes.size();
  for (const auto& listener : listeners_) {
    listener->now_ns = arrival_ns;
    listener->decoder->feed(bytes, *listener);
  }
}

bool Recognizer::promising() const {
  return std::any_of(listeners_.begin(), listeners_.end(), [](const auto& listener) {
    return rank_of(listener->protocol->name) < 2 && listener->samples() > 0;
  });
}

std::optional<Recognition> Recognizer::best() const {
  const Listener* found = nullptr;
  for (const auto& listener : listeners_) {
    const int rank = rank_of(listener->protocol->name);
    const Demand demand = demand_of(rank);
    if (listener->samples() < demand.samples || listener->share() < demand.share) continue;
    if (found == nullptr || rank < rank_of(found->protocol->name) ||
        (rank == rank_of(found->protocol->name) && listener->samples() > found->samples()))
      found = listener.get();
  }
  if (found == nullptr) return std::nullopt;
  Recognition out;
  out.protocol = found->protocol->name;
  out.share = found->share();
  for (const auto& [kind, seen] : found->kinds) {
    const double span_s = to_seconds(seen.last_ns - seen.gathered_ns);
    const bool enough = seen.samples >= 3 && span_s > 0.0;
    const auto counted = static_cast<double>(seen.samples - seen.gathered);
    out.kinds.push_back({kind, seen.samples, enough ? counted / span_s : 0.0});
  }
  out.latitude_rad = found->latitude_rad;
  if (const auto imu = found->kinds.find(SourceKind::imu); imu != found->kinds.end()) {
    std::array<double, 3> mean{};
    for (std::size_t i = 0; i < 3; ++i)
      mean[i] = found->force_sum[i] / static_cast<double>(imu->second.samples);
    out.mean_force_S = mean;
  }
  out.depth_m = found->depth_m;
  return out;
}

}  // namespace fathom::cli
