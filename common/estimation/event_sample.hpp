#pragma once

#include <type_traits>
#include <variant>

#include "samples/command.hpp"
#include "samples/kinds.hpp"

namespace fathom::estimation {

namespace detail {
template <class... Samples>
using CommandOr = std::variant<Command, Samples...>;
}  // namespace detail

/// An order, or a sample of a kind that aids. Its index, which archives keep, is 0 of an order and else the
/// place of the kind among those that aid.
using EventSample = AidingKinds::Samples<detail::CommandOr>;

[[nodiscard]] inline const SampleHeader& header_of(const EventSample& sample) {
  return std::visit([](const auto& one) -> const SampleHeader& { return one.header; }, sample);
}

/// The kind; of an order that of the inertial unit, which does not aid.
[[nodiscard]] inline SourceKind source_of(const EventSample& sample) {
  return std::visit(
      []<class Sample>(const Sample& /*one*/) {
        if constexpr (std::is_same_v<Sample, Command>)
          return SourceKind::imu;
        else
          return kSourceOf<Sample>;
      },
      sample);
}

/// Whether it is measured against the water layer.
[[nodiscard]] inline bool is_of_water(const EventSample& sample) {
  const auto* dvl = std::get_if<DvlSample>(&sample);
  return dvl != nullptr && dvl->mode == DvlMode::water;
}

}  // namespace fathom::estimation
