// Samples as they travel. The first byte chooses the type; the rest are its bytes. What is taken has to
// travel on to the same bytes.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "bus/cdr.hpp"
#include "bus/topics.hpp"
#include "driver.hpp"
#include "unit/bus/sample_fields.hpp"

namespace {

using namespace fathom;

template <class T>
void check(std::span<const std::uint8_t> bytes) {
  const auto sample = bus::from_cdr<T>(bytes);
  if (!sample) return;
  const auto once = bus::to_cdr(*sample);
  const auto again = bus::from_cdr<T>(once);
  if (!again || test::Dump::of(*again) != test::Dump::of(*sample)) {
    (void)std::fprintf(stderr, "a sample of %zu bytes travels on as another one\n", bytes.size());
    std::abort();
  }
}

template <class... T>
struct Types {
  static constexpr std::size_t kCount = sizeof...(T);
  static void check_one(std::size_t which, std::span<const std::uint8_t> bytes) {
    std::size_t i = 0;
    (void)((i++ == which && (check<T>(bytes), true)) || ...);
  }
};
using All = Types<ImuSample, DvlSample, GpsSample, DepthSample, AltimeterSample, RangeSample, FixSample,
                  HeadingSample, UsblSample, AirspeedSample, PropulsionSample, FinsSample, NavState,
                  NavDetail, Verdict, AlignmentStatus, Forecast, Alarm, MonitorStatus, ServiceStatus, Command,
                  ReplicaStatus, EngineStatePart, Route, Truth>;
constexpr std::uint8_t kMonitorStatus = 18;  // text, enumerators, lists of structs: everything at once

}  // namespace

std::string_view fathom::fuzz::target_name() {
  return "cdr";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  MonitorStatus sample;
  test::Filler(3, test::Lists::one).fill(sample);
  std::vector<std::uint8_t> out{kMonitorStatus};
  const auto bytes = bus::to_cdr(sample);
  out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // Exactly sized, so that a sanitizer sees every read beyond the end.
  const auto bytes = std::make_unique<std::uint8_t[]>(size - 1);
  std::copy(data + 1, data + size, bytes.get());
  All::check_one(data[0] % All::kCount, {bytes.get(), size - 1});
  return 0;
}
