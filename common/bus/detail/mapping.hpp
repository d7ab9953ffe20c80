#pragma once

// How a topic's file says, once, which field of the plain sample is which field of the wire type; both
// directions follow from that. See topics/depth.cpp for the simplest case. Only files in bus/topics/ include
// this.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/name.hpp"
#include "bus/cdr.hpp"
#include "bus/detail/topic_ops.hpp"
#include "bus/detail/versions/cdr.hpp"
#include "samples/header.hpp"

namespace fathom::bus::detail {

/// At most `limit` bytes of `text`, never ending inside a UTF-8 character.
inline std::string_view cut(std::string_view text, std::size_t limit) {
  if (text.size() <= limit) return text;
  while (limit > 0 && (static_cast<unsigned char>(text[limit]) & 0xC0U) == 0x80U) --limit;
  return text.substr(0, limit);
}

/// Visitor that copies plain -> wire. Text and lists longer than the wire's bound are cut.
struct ToWire {
  template <class Plain, class Wire>
  void operator()(const Plain& plain, Wire& wire) {
    if constexpr (std::is_same_v<Plain, Name>) {
      wire = plain.c_str();
    } else if constexpr (std::is_same_v<Plain, std::string>) {
      wire = std::string(cut(plain, Wire::max_size));
    } else {
      static_assert(std::is_same_v<Plain, Wire>);
      wire = plain;
    }
  }

  template <class Plain, class Wire>
  void enumeration(Plain plain, Wire& wire, Plain /*last*/) {
    wire = static_cast<Wire>(plain);
  }

  template <std::size_t N>
  void text(const std::array<char, N>& plain, auto& wire) {
    const std::string_view all(plain.data(), N);
    wire = std::string(cut(all.substr(0, all.find('\0')), N - 1));
  }

  /// Fixed storage with a count.
  template <class Plain, std::size_t N, class Wire, class Each>
  void sequence(const std::array<Plain, N>& plain, std::uint32_t count, std::vector<Wire>& wire, Each each) {
    wire.resize(std::min<std::size_t>(count, N));
    for (std::size_t i = 0; i < wire.size(); ++i) each(*this, plain[i], wire[i]);
  }

  template <class Plain, class Wire, class Each>
  void sequence(const std::vector<Plain>& plain, std::vector<Wire>& wire, std::size_t bound, Each each) {
    wire.resize(std::min(plain.size(), bound));
    for (std::size_t i = 0; i < wire.size(); ++i) each(*this, plain[i], wire[i]);
  }
};

/// Visitor that copies wire -> plain and notices what a plain sample cannot hold.
struct FromWire {
  bool valid = true;

  template <class Plain, class Wire>
  void operator()(Plain& plain, const Wire& wire) {
    if constexpr (std::is_same_v<Plain, Name>) {
      plain = Name(wire.c_str());
    } else if constexpr (std::is_same_v<Plain, std::string>) {
      plain = wire.c_str();
    } else {
      static_assert(std::is_same_v<Plain, Wire>);
      plain = wire;
    }
  }

  template <class Plain, class Wire>
  void enumeration(Plain& plain, Wire wire, Plain last) {
    if (static_cast<std::uint32_t>(wire) > static_cast<std::uint32_t>(last)) {
      valid = false;
      return;
    }
    plain = static_cast<Plain>(wire);
  }

  template <std::size_t N>
  void text(std::array<char, N>& plain, const auto& wire) {
    const std::string_view from = cut(wire.c_str(), N - 1);
    plain.fill('\0');
    std::copy(from.begin(), from.end(), plain.begin());
  }

  template <class Plain, std::size_t N, class Wire, class Each>
  void sequence(std::array<Plain, N>& plain, std::uint32_t& count, const std::vector<Wire>& wire, Each each) {
    if (wire.size() > N) valid = false;
    count = static_cast<std::uint32_t>(std::min(wire.size(), N));
    for (std::size_t i = 0; i < count; ++i) each(*this, plain[i], wire[i]);
  }

  template <class Plain, class Wire, class Each>
  void sequence(std::vector<Plain>& plain, const std::vector<Wire>& wire, std::size_t bound, Each each) {
    if (wire.size() > bound) valid = false;
    plain.resize(std::min(wire.size(), bound));
    for (std::size_t i = 0; i < plain.size(); ++i) each(*this, plain[i], wire[i]);
  }
};

/// Visitor that only reads past the fields, to check the lengths of lists before anything allocates room for
/// them: four bytes from the network could otherwise claim gigabytes. Text beyond its bound, which the wire
/// types would cut in silence, is refused as well. Relies on fields() having the order of the IDL.
struct ListCheck {
  Cdr& cdr;
  bool valid = true;

  template <class Plain, class Wire>
  void operator()(Plain& /*plain*/, Wire& /*wire*/) {
    if (!valid) return;
    if constexpr (std::is_same_v<Plain, Name> || std::is_same_v<Plain, std::string>) {
      bounded_text(Wire::max_size);
    } else {
      Wire value;
      cdr >> value;
    }
  }

  template <class Plain, class Wire>
  void enumeration(Plain& /*plain*/, Wire& /*wire*/, Plain /*last*/) {
    std::uint32_t value = 0;
    if (valid) cdr >> value;
  }

  template <std::size_t N>
  void text(std::array<char, N>& /*plain*/, auto& wire) {
    if (valid) bounded_text(std::remove_reference_t<decltype(wire)>::max_size);
  }

  template <class Plain, std::size_t N, class Wire, class Each>
  void sequence(std::array<Plain, N>& /*plain*/, std::uint32_t& /*count*/, std::vector<Wire>& /*wire*/,
                Each each) {
    elements<Plain, Wire>(N, each);
  }

  template <class Plain, class Wire, class Each>
  void sequence(std::vector<Plain>& /*plain*/, std::vector<Wire>& /*wire*/, std::size_t bound, Each each) {
    elements<Plain, Wire>(bound, each);
  }

 private:
  void bounded_text(std::size_t most) {
    std::string text;
    cdr >> text;
    valid = text.size() <= most;
  }

  template <class Plain, class Wire>
  void elements(std::size_t bound, auto each) {
    if (!valid) return;
    std::uint32_t length = 0;
    cdr >> length;
    valid = length <= bound;
    Plain plain;
    Wire wire;
    for (std::uint32_t i = 0; valid && i < length; ++i) each(*this, plain, wire);
  }
};

/// One enumeration, given the last enumerator of both sides. Both start at 0 and have the same order.
template <auto kLastPlain, auto kLastWire>
void copy_enum(auto& copy, auto& plain, auto&& wire) {
  static_assert(static_cast<std::uint32_t>(kLastPlain) == static_cast<std::uint32_t>(kLastWire));
  copy.enumeration(plain, wire, kLastPlain);
}

/// The five fields that every type starts with.
template <class Copy, class Header, class Wire>
void copy_header(Copy& copy, Header& header, Wire& wire) {
  copy(header.vehicle, wire.vehicle());
  copy(header.sensor, wire.sensor());
  copy(header.stamp_ns, wire.stamp_ns());
  copy(header.received_ns, wire.received_ns());
  copy(header.sequence, wire.sequence_number());
}

/// Says how T travels; specialised in topics/. Members:
///   using Wire = v1::...;                       the generated type
///   static constexpr const char* kTopic, * kType;
///   template <class Copy, class Plain, class WireRef>
///   static void fields(Copy& copy, Plain& plain, WireRef& wire);   every field, both directions
///   static std::string key_text(const T& sample);
///   static constexpr bool kHasLists = true;                        where fields() calls copy.sequence
template <class T>
struct Mapping;

/// Key of the types keyed by vehicle and sensor.
template <class T>
std::string vehicle_and_sensor(const T& sample) {
  return sample.header.vehicle.str() + "/" + sample.header.sensor.str();
}

template <class T>
typename Mapping<T>::Wire to_wire(const T& sample) {
  typename Mapping<T>::Wire wire;
  ToWire copy;
  Mapping<T>::fields(copy, sample, wire);
  return wire;
}

template <class T>
TopicOps make_ops() {
  using M = Mapping<T>;
  using Wire = typename M::Wire;
  TopicOps ops{};
  ops.topic = M::kTopic;
  ops.type_name = M::kType;
  ops.max_size = max_encoding<Wire>();
  ops.max_key_size = max_key_encoding<Wire>();
  ops.create = [] { return static_cast<void*>(new T()); };
  ops.destroy = [](void* sample) { delete static_cast<T*>(sample); };
  ops.encode = [](const void* sample, Cdr& cdr) { cdr << to_wire(*static_cast<const T*>(sample)); };
  ops.decode = [](Cdr& cdr, void* sample) {
    Wire wire;
    if constexpr (requires { M::kHasLists; }) {
      Cdr::state start = position_of(cdr);
      T scratch;
      ListCheck check{cdr};
      M::fields(check, scratch, wire);
      if (!check.valid) return false;
      go_back(cdr, start);
    }
    if (!decode_whole(cdr, wire)) return false;
    FromWire copy;
    M::fields(copy, *static_cast<T*>(sample), static_cast<const Wire&>(wire));
    return copy.valid;
  };
  ops.encode_key = [](const void* sample, Cdr& cdr) {
    detail::encode_key(to_wire(*static_cast<const T*>(sample)), cdr);
  };
  ops.key_text = [](const void* sample) { return M::key_text(*static_cast<const T*>(sample)); };
  ops.header = [](void* sample) -> SampleHeader& { return static_cast<T*>(sample)->header; };
  return ops;
}

template <class T>
const TopicOps& topic_ops() {
  static const TopicOps ops = make_ops<T>();
  return ops;
}

}  // namespace fathom::bus::detail

namespace fathom::bus {

template <class T>
std::vector<std::uint8_t> to_cdr(const T& sample) {
  return detail::encode(detail::topic_ops<T>(), &sample);
}
template <class T>
std::optional<T> from_cdr(std::span<const std::uint8_t> bytes) {
  T sample;
  if (!detail::decode(detail::topic_ops<T>(), bytes, &sample)) return std::nullopt;
  return sample;
}

}  // namespace fathom::bus

/// Everything that exists per topic type, at the end of each file in topics/.
#define FATHOM_BUS_TOPIC(T)                                             \
  namespace fathom::bus {                                               \
  template const detail::TopicOps& detail::topic_ops<T>();              \
  template std::vector<std::uint8_t> to_cdr<T>(const T&);               \
  template std::optional<T> from_cdr<T>(std::span<const std::uint8_t>); \
  }
