#pragma once

// Recordings made of random messages, for the tests of reader and writer.

#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "record/reader.hpp"
#include "record/writer.hpp"

namespace fathom::test {

struct Said {
  std::string topic;
  std::uint32_t sequence = 0;
  TimeNs log_time = 0;
  TimeNs publish_time = 0;
  record::Bytes data;
  bool operator==(const Said&) const = default;
};

struct Made {
  record::Bytes bytes;
  std::vector<Said> said;           ///< in the order of writing
  std::vector<std::size_t> chunks;  ///< messages up to the end of each flush
  record::TextMap metadata;
  record::Bytes attachment;
};

/// A file of `messages` messages over three topics, flushed now and then. With `groups` they are brought
/// together by their log times, which grow then.
inline Made made_file(std::uint32_t seed, record::Compression compression, int messages = 200,
                      std::size_t chunk_bytes = 2000, bool groups = false) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
  Made out;
  record::Writer writer(std::make_unique<record::MemorySink>(out.bytes),
                        {compression, chunk_bytes, "", "test"});
  std::string why = writer.begin();
  const std::uint16_t schema = writer.add_schema("fathom::v1::A", "omgidl", "module m {};");
  const std::uint16_t other = writer.add_schema("fathom::v1::B", "omgidl", "");
  std::vector<std::pair<std::uint16_t, std::string>> channels;
  channels.emplace_back(writer.add_channel(schema, "a", "cdr", {{"key", "value"}}), "a");
  channels.emplace_back(writer.add_channel(other, "b", "cdr", {}, groups ? 1 : 0), "b");
  channels.emplace_back(writer.add_channel(schema, "c", "cdr", {}, groups ? 2 : 0), "c");
  writer.add_channel(0, "never", "cdr");
  out.attachment = {1, 2, 3, 0, 255};
  why += writer.attach({5, 4, "config.json", "application/json", out.attachment, 0});
  TimeNs now = 1'000;
  for (int i = 0; i < messages; ++i) {
    const auto& [id, topic] = channels[below(i < messages / 2 ? 2 : 3)];
    now += groups ? 7 : below(3) * 10;
    Said one{topic, static_cast<std::uint32_t>(i), now - below(5), now - 100, {}};
    one.data.resize(below(60));
    for (auto& byte : one.data) byte = static_cast<std::uint8_t>(below(4));
    why += writer.write({id, one.sequence, one.log_time, one.publish_time, one.data});
    out.said.push_back(std::move(one));
    if (below(10) == 0) why += writer.flush();
  }
  out.metadata = {{"dropped", "0"}, {"", "empty key"}};
  why += writer.add({"notes", out.metadata});
  why += writer.finish();
  if (!why.empty()) throw std::runtime_error(why);
  return out;
}

inline Result<record::Reader> reader_of(const record::Bytes& bytes, const record::Limits& limits = {}) {
  return record::Reader::open(std::make_unique<record::MemorySource>(bytes), limits);
}

/// The messages of a selection.
inline std::vector<Said> read_all(record::Reader& reader, record::Outcome& outcome,
                                  const record::Selection& selection = {}) {
  std::vector<Said> said;
  outcome = reader.read(selection, [&](const record::Channel& channel, const record::Message& message) {
    said.push_back({channel.topic,
                    message.sequence,
                    message.log_time,
                    message.publish_time,
                    {message.data.begin(), message.data.end()}});
    return true;
  });
  return said;
}

}  // namespace fathom::test
