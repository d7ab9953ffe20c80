#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "samples/header.hpp"

namespace eprosima::fastcdr {
class Cdr;
}

namespace fathom::bus::detail {

/// What the bus needs to know about one topic, with the sample's type erased: `sample` always points to the
/// plain value. One per topic, made from its Mapping (detail/mapping.hpp).
struct TopicOps {
  const char* topic;           ///< name on the network and of the QoS profile
  const char* type_name;       ///< as in the IDL
  std::uint32_t max_size;      ///< serialised, without encapsulation
  std::uint32_t max_key_size;  ///< serialised key

  void* (*create)();
  void (*destroy)(void* sample);
  void (*encode)(const void* sample, eprosima::fastcdr::Cdr& cdr);
  /// False when the bytes are a legal encoding of something no sample can hold: an unknown enumerator, a
  /// sequence beyond its bound. Throws what Fast CDR throws when bytes are missing.
  bool (*decode)(eprosima::fastcdr::Cdr& cdr, void* sample);
  void (*encode_key)(const void* sample, eprosima::fastcdr::Cdr& cdr);
  /// The key in words, e.g. "auv/gps0", for reports.
  std::string (*key_text)(const void* sample);
  /// What every sample begins with.
  SampleHeader& (*header)(void* sample);
};

/// The operations of the topic of T, instantiated in bus/topics/.
template <class T>
const TopicOps& topic_ops();

/// The operations of every topic, in the order of all_topics().
[[nodiscard]] const std::vector<const TopicOps*>& all_topic_ops();

/// Behind to_cdr and from_cdr.
std::vector<std::uint8_t> encode(const TopicOps& ops, const void* sample);
bool decode(const TopicOps& ops, std::span<const std::uint8_t> bytes, void* sample);

/// Bytes written; 0 when they do not fit.
std::size_t encode_into(const TopicOps& ops, const void* sample, std::span<char> into);
/// As decode(). Nothing is written to the bytes: Fast CDR asks for what it only reads.
bool decode_from(const TopicOps& ops, std::span<char> bytes, void* sample);

}  // namespace fathom::bus::detail
