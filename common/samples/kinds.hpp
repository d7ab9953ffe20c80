#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "samples/actuator.hpp"
#include "samples/airspeed.hpp"
#include "samples/altimeter.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "samples/position/fix.hpp"
#include "samples/range.hpp"
#include "samples/usbl.hpp"

/// The kinds of instrument: one row each in the table `Kinds`. Whatever goes over all kinds is made from it
/// by the compiler: variants of any sample, readers and writers, topics and permissions, data set streams,
/// words in configurations and reports. A place that a new kind needs and does not have does not compile or
/// link.
namespace fathom {

/// The number of each kind, as published in verdicts and kept in archives: it never changes.
enum class SourceKind : std::uint8_t {
  imu = 0,
  gps = 1,
  dvl = 2,
  depth = 3,
  heading = 4,
  usbl = 5,
  airspeed = 6,
  propulsion = 7,
  fins = 8,
  altimeter = 9,
  range = 10,
  fix = 11,
};

/// What navigation does with a kind: the inertial unit is integrated, others aid, and some only inform:
/// nothing that is estimated depends on them.
enum class Use : std::uint8_t { integrated, aiding, informing };

/// Text as part of a type.
template <std::size_t N>
struct Text {
  // NOLINTNEXTLINE(google-explicit-constructor,cppcoreguidelines-avoid-c-arrays): from a literal, that is all
  consteval Text(const char (&text)[N]) {
    for (std::size_t i = 0; i < N; ++i) letters[i] = text[i];
  }
  [[nodiscard]] constexpr std::string_view view() const { return {letters.data(), N - 1}; }
  std::array<char, N> letters{};
};

template <Text A, Text B>
struct Joined {
  static constexpr std::size_t kLength = A.view().size() + B.view().size();
  static constexpr auto kLetters = [] {
    std::array<char, kLength + 1> out{};
    std::size_t at = 0;
    for (const char letter : A.view()) out[at++] = letter;
    for (const char letter : B.view()) out[at++] = letter;
    return out;
  }();
  static constexpr std::string_view view() { return {kLetters.data(), kLength}; }
};

/// One row. The word is the kind's name in configurations, files and reports, and that of its topic. The role
/// is that of the service that publishes it, which is also the name of its configuration.
template <class SampleType, SourceKind kKind, Text kWordText, Text kRoleText, Use kUsed = Use::aiding>
struct Kind {
  using Sample = SampleType;
  static constexpr SourceKind kSource = kKind;
  static constexpr std::string_view kWord = kWordText.view();
  static constexpr std::string_view kTopic = Joined<"fathom/v1/", kWordText>::view();
  static constexpr std::string_view kRole = kRoleText.view();
  static constexpr Use kUse = kUsed;
};

template <class... Rows>
struct KindList {
  static constexpr std::size_t kSize = sizeof...(Rows);
  /// A template over the samples of the list, e.g. std::variant.
  template <template <class...> class Of>
  using Samples = Of<typename Rows::Sample...>;
  template <template <class...> class Of>
  using RowsIn = Of<Rows...>;
};

using Kinds = KindList<  //
    Kind<ImuSample, SourceKind::imu, "imu", "imu_bridge", Use::integrated>,
    Kind<GpsSample, SourceKind::gps, "gps", "gps_bridge">,
    Kind<DvlSample, SourceKind::dvl, "dvl", "dvl_bridge">,
    Kind<DepthSample, SourceKind::depth, "depth", "depth_bridge">,
    Kind<HeadingSample, SourceKind::heading, "heading", "heading_bridge">,
    Kind<UsblSample, SourceKind::usbl, "usbl", "usbl_bridge">,
    Kind<AirspeedSample, SourceKind::airspeed, "airspeed", "air_data_bridge">,
    Kind<PropulsionSample, SourceKind::propulsion, "propulsion", "actuator_bridge">,
    Kind<FinsSample, SourceKind::fins, "fins", "actuator_bridge">,
    Kind<AltimeterSample, SourceKind::altimeter, "altimeter", "altimeter_bridge", Use::informing>,
    Kind<RangeSample, SourceKind::range, "range", "range_bridge">,
    Kind<FixSample, SourceKind::fix, "fix", "fix_bridge">>;

inline constexpr std::size_t kSourceKinds = Kinds::kSize;
/// The highest number of a kind, for checks of what comes from outside.
inline constexpr SourceKind kLastKind = static_cast<SourceKind>(kSourceKinds - 1);

namespace detail {

template <class Done, class... Rows>
struct AidingOf {
  using type = Done;
};
template <class... Kept, class Row, class... Rows>
struct AidingOf<KindList<Kept...>, Row, Rows...> {
  using Next = std::conditional_t<Row::kUse == Use::aiding, KindList<Kept..., Row>, KindList<Kept...>>;
  using type = typename AidingOf<Next, Rows...>::type;
};
template <class... Rows>
using AidingRows = typename AidingOf<KindList<>, Rows...>::type;

template <class Sample, class... Rows>
struct RowOf;
template <class Sample, class Row, class... Rows>
struct RowOf<Sample, Row, Rows...> : std::conditional_t<std::is_same_v<Sample, typename Row::Sample>,
                                                        std::type_identity<Row>, RowOf<Sample, Rows...>> {};
template <class Sample>
struct RowOf<Sample> {};  // no such kind

template <class... Rows>
constexpr bool in_order(KindList<Rows...> /*list*/) {
  std::size_t number = 0;
  return ((static_cast<std::size_t>(Rows::kSource) == number++) && ...);
}
static_assert(in_order(Kinds{}), "a row for each SourceKind, in the order of their numbers");

template <class F, class... Rows>
constexpr void for_each_row(KindList<Rows...> /*list*/, F&& f) {
  (f(Rows{}), ...);
}

}  // namespace detail

/// Those that aid, in the same order.
using AidingKinds = Kinds::RowsIn<detail::AidingRows>;

namespace detail {
template <class Sample, class List>
struct KindIn;
template <class Sample, class... Rows>
struct KindIn<Sample, KindList<Rows...>> : RowOf<Sample, Rows...> {};
}  // namespace detail

/// The row of a sample's type.
template <class Sample>
using KindOf = typename detail::KindIn<Sample, Kinds>::type;

template <class Sample>
concept OfAKind = requires {
  typename KindOf<Sample>;
};
template <class Sample>
concept Aiding = OfAKind<Sample> && KindOf<Sample>::kUse == Use::aiding;
template <class Sample>
concept Informing = OfAKind<Sample> && KindOf<Sample>::kUse == Use::informing;

template <OfAKind Sample>
inline constexpr SourceKind kSourceOf = KindOf<Sample>::kSource;

/// Calls `f` with each row: `for_each_kind([](auto kind) { using Sample = typename decltype(kind)::Sample;
/// })`.
template <class F>
constexpr void for_each_kind(F&& f) {
  detail::for_each_row(Kinds{}, f);
}
template <class F>
constexpr void for_each_aiding_kind(F&& f) {
  detail::for_each_row(AidingKinds{}, f);
}

/// A sample of any kind; its index is the number of its SourceKind.
using AnySample = Kinds::Samples<std::variant>;

[[nodiscard]] inline SourceKind source_of(const AnySample& sample) {
  return static_cast<SourceKind>(sample.index());
}

[[nodiscard]] inline const SampleHeader& header_of(const AnySample& sample) {
  return std::visit([](const auto& one) -> const SampleHeader& { return one.header; }, sample);
}

/// "imu", "gps", ...; "unknown" for a number that is none.
[[nodiscard]] std::string_view to_string(SourceKind source);
[[nodiscard]] std::optional<SourceKind> kind_named(std::string_view word);
/// The role that publishes a kind.
[[nodiscard]] std::string_view role_of(SourceKind source);
/// Every role of the table once, in the order of the kinds.
[[nodiscard]] std::span<const std::string_view> bridge_roles();

}  // namespace fathom
