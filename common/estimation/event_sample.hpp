#pragma once

#include <variant>

#include "samples/command.hpp"
#include "samples/kinds.hpp"

namespace fathom::estimation {

namespace detail {
template <class... Samples>
using CommandOr = std::variant<Command, Samples...>;
}  // namespace detail

/// An order, or a sample of a kind that aids. Its index is the number of the kind, 0 of an order: the
/// inertial unit does not aid.
using EventSample = AidingKinds::Samples<detail::CommandOr>;

[[nodiscard]] inline const SampleHeader& header_of(const EventSample& sample) {
  return std::visit([](const auto& one) -> const SampleHeader& { return one.header; }, sample);
}

/// Whether it is measured against the water layer.
[[nodiscard]] inline bool is_of_water(const EventSample& sample) {
  const auto* dvl = std::get_if<DvlSample>(&sample);
  return dvl != nullptr && dvl->mode == DvlMode::water;
}

static_assert(std::variant_size_v<EventSample> == kSourceKinds && kSourceOf<ImuSample> == SourceKind{});

}  // namespace fathom::estimation
