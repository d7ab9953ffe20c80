#include "bus/raw.hpp"

#include <string>
#include <utility>

#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/sample_type.hpp"

namespace fathom::bus {
namespace {

const detail::TopicOps& ops_of(std::string_view topic) {
  for (const detail::TopicOps* ops : detail::all_topic_ops()) {
    if (ops->topic == topic) return *ops;
  }
  throw BusError("topic " + std::string(topic) + ": not known to this build");
}

}  // namespace

bool is_latched(Participant& participant, const std::string& topic) {
  const auto qos = detail::reader_qos(*participant.impl().subscriber, topic, {});
  return qos.durability().kind != detail::dds::VOLATILE_DURABILITY_QOS;
}

std::optional<std::string> key_of(std::string_view topic, std::span<const std::uint8_t> bytes) {
  const detail::TopicOps& ops = ops_of(topic);
  const std::unique_ptr<void, void (*)(void*)> sample(ops.create(), ops.destroy);
  if (!detail::decode(ops, bytes, sample.get())) return std::nullopt;
  return ops.key_text(sample.get());
}

std::optional<std::vector<std::uint8_t>> with_header(std::string_view topic,
                                                     std::span<const std::uint8_t> bytes,
                                                     const std::function<void(SampleHeader&)>& change) {
  const detail::TopicOps& ops = ops_of(topic);
  const std::unique_ptr<void, void (*)(void*)> sample(ops.create(), ops.destroy);
  if (!detail::decode(ops, bytes, sample.get())) return std::nullopt;
  change(ops.header(sample.get()));
  return detail::encode(ops, sample.get());
}

struct RawReader::Impl {
  detail::ReaderCore core;
};

RawReader::RawReader(Participant& participant, std::string_view topic, Handler handler,
                     const ReaderOptions& options)
    : impl_(new Impl{detail::ReaderCore(
          participant, ops_of(topic),
          [handler = std::move(handler)](const void* sample, const SampleInfo& info) {
            handler(*static_cast<const detail::RawSample*>(sample), info);
          },
          options, true)}) {}
RawReader::~RawReader() = default;
int RawReader::matched_writers() const {
  return impl_->core.matched_writers();
}

struct RawWriter::Impl {
  detail::WriterCore core;
};

RawWriter::RawWriter(Participant& participant, std::string_view topic, const WriterOptions& options)
    : impl_(new Impl{detail::WriterCore(participant, ops_of(topic), options)}) {}
RawWriter::~RawWriter() = default;
bool RawWriter::write(std::vector<std::uint8_t> bytes) {
  return impl_->core.write_raw(std::move(bytes));
}
int RawWriter::matched_readers() const {
  return impl_->core.matched_readers();
}

}  // namespace fathom::bus
