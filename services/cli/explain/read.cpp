#include "cli/explain/read.hpp"

#include <map>

#include "bus/cdr.hpp"
#include "cli/recording.hpp"

namespace fathom::cli {
namespace {

struct Entry {
  std::string topic;
  bool (*add)(explain::History&, std::span<const std::uint8_t>, const explain::Arrival&);
};

template <class T>
bool add_as(explain::History& history, std::span<const std::uint8_t> data, const explain::Arrival& arrival) {
  const auto sample = bus::from_cdr<T>(data);
  if (sample) history.add(*sample, arrival);
  return sample.has_value();
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = [] {
    std::vector<Entry> out;
    for_each_kind([&](auto kind) {
      out.push_back({std::string(kind.kTopic), add_as<typename decltype(kind)::Sample>});
    });
    out.push_back({"fathom/v1/nav_state", add_as<NavState>});
    out.push_back({"fathom/v1/verdict", add_as<Verdict>});
    out.push_back({"fathom/v1/alignment", add_as<AlignmentStatus>});
    out.push_back({"fathom/v1/service_status", add_as<ServiceStatus>});
    out.push_back({"fathom/v1/alarm", add_as<Alarm>});
    out.push_back({"fathom/v1/command", add_as<Command>});
    out.push_back({"fathom/v1/intake", add_as<IntakeRecord>});
    return out;
  }();
  return all;
}

}  // namespace

std::vector<std::string> explained_topics() {
  std::vector<std::string> out;
  for (const Entry& one : entries()) out.push_back(one.topic);
  return out;
}

bool add_message(explain::History& history, std::string_view topic, std::span<const std::uint8_t> data,
                 const explain::Arrival& arrival) {
  for (const Entry& one : entries())
    if (one.topic == topic) return one.add(history, data, arrival);
  return false;
}

std::vector<std::string> read_into(explain::History& history, record::Reader& reader,
                                   record::Selection selection) {
  selection.topics = explained_topics();
  struct Source {
    const Entry* entry = nullptr;
    std::string writer;
    std::string process;
  };
  std::map<std::uint16_t, Source> sources;
  std::map<std::string, std::uint64_t> broken;
  record::Outcome outcome =
      reader.read(selection, [&](const record::Channel& channel, const record::Message& message) {
        const auto [found, is_new] = sources.try_emplace(channel.id);
        Source& source = found->second;
        if (is_new) {
          for (const Entry& one : entries())
            if (one.topic == channel.topic) source.entry = &one;
          source.writer = writer_of(channel);
          source.process = process_of(channel);
        }
        const explain::Arrival arrival{message.log_time, source.writer, source.process};
        if (source.entry == nullptr || !source.entry->add(history, message.data, arrival))
          ++broken[channel.topic];
        return true;
      });
  for (const auto& [topic, count] : broken)
    outcome.problems.push_back(topic + ": " + std::to_string(count) + " messages are none of its type");
  return std::move(outcome.problems);
}

}  // namespace fathom::cli
