#pragma once

#include <cstddef>
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

static_assert(
    [] {
      std::size_t number = 1;
      bool equal = true;
      for_each_aiding_kind(
          [&](auto kind) { equal = equal && static_cast<std::size_t>(kind.kSource) == number++; });
      return equal;
    }(),
    "kinds that aid are numbered from 1 without a gap");

}  // namespace fathom::estimation
