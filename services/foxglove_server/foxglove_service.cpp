#include "foxglove_server/foxglove_service.hpp"

#include <fstream>
#include <map>
#include <mutex>
#include <utility>

#include "base/disk/regular_file.hpp"
#include "bus/raw.hpp"
#include "bus/topics.hpp"
#include "config/json/error.hpp"
#include "config/token_book.hpp"
#include "foxglove_server/ws_server.hpp"
#include "record/idl.hpp"
#include "runtime/build_info.hpp"
#include "runtime/refusal_log.hpp"

namespace fathom::foxglove {
namespace {

constexpr std::size_t kMostKept = 512;  // of a topic; keys come from the network: bounded

config::TokenBook tokens_of(const config::FoxgloveConfig& config, const std::string& file) {
  if (config.access.token_file.empty()) return {};
  try {
    return config::TokenBook::load(config.access.token_file);
  } catch (const config::TokenError& error) {
    throw config::ConfigError(file, std::string("access.token_file: ") + error.what());
  }
}

/// All topics but the engine's state, which is for those who may take over.
std::vector<Channel> channels_on_offer() {
  std::vector<Channel> out;
  for (const bus::TopicInfo& topic : bus::all_topics()) {
    if (std::string_view(topic.topic) == "fathom/v1/engine_state") continue;
    const auto idl = record::self_contained_idl(record::idl_files(), topic.type);
    if (!idl) continue;
    out.push_back({static_cast<std::uint32_t>(out.size() + 1), topic.topic, topic.type, idl.value()});
  }
  return out;
}

}  // namespace

void verify(const config::FoxgloveConfig& config, const std::string& file, bool /*check*/) {
  (void)tokens_of(config, file);
  for (const auto& [key, path] : {std::pair{"tls.certificate_file", config.tls.certificate_file},
                                  std::pair{"tls.key_file", config.tls.key_file}}) {
    if (path.empty()) continue;
    const std::string value = "\"" + path + "\"";
    if (const std::string wrong = no_regular_file(path); !wrong.empty())
      throw config::ConfigError(file, key, value, "a file that can be read; it " + wrong);
    if (!std::ifstream(path)) throw config::ConfigError(file, key, value, "a file that can be read");
  }
}

struct FoxgloveService::Impl {
  Impl(host::ServiceHost& the_host, const config::FoxgloveConfig& config)
      : host(the_host),
        needs_token(config.access.view_needs_token),
        tokens(tokens_of(config, "")),
        channels(channels_on_offer()),
        server(options_of(config), handlers()) {
    host.on_status([this](ServiceStatus& status) { fill(status); });
  }
  ~Impl() {
    host.on_status([](ServiceStatus&) {});
    std::map<std::uint32_t, std::unique_ptr<bus::RawReader>> ending;
    {
      const std::lock_guard lock(mutex);
      is_ending = true;
      ending = std::move(readers);
    }
    ending.clear();  // before the server, to which they speak
  }

  [[nodiscard]] WsServer::Options options_of(const config::FoxgloveConfig& config) const {
    return {.address = config.address,
            .port = config.port,
            .most_clients = static_cast<std::size_t>(config.most_clients),
            .queue_bytes = static_cast<std::size_t>(config.queue_mb * 1e6),
            .certificate_file = config.tls.certificate_file,
            .key_file = config.tls.key_file,
            .name = "fathom " + std::string(runtime::version()) + ", " + config.common.vehicle,
            .session = std::to_string(host.clock().utc_ns()),
            .channels = channels};
  }
  [[nodiscard]] WsServer::Handlers handlers() {
    return {.may_look =
                [this](std::string_view token) {
                  return !needs_token || tokens.whois(token).role >= config::Role::viewer;
                },
            .wanted = [this](std::uint32_t channel, bool is_wanted) { want(channel, is_wanted); },
            .kept = [this](std::uint32_t channel) { return kept_of(channel); },
            .say =
                [log = &host.log()](bool is_trouble, const std::string& text) {
                  log->write(is_trouble ? runtime::LogLevel::warning : runtime::LogLevel::info, text);
                }};
  }

  /// On the server's thread.
  void want(std::uint32_t channel, bool is_wanted) {
    std::unique_ptr<bus::RawReader> ending;  // outside of the lock, because it waits for its handler
    {
      const std::lock_guard lock(mutex);
      if (is_ending) return;
      const auto found = readers.find(channel);
      if (found != readers.end()) {
        ending = std::move(found->second);
        readers.erase(found);
      }
    }
    ending.reset();
    {
      const std::lock_guard lock(kept_mutex);
      kept.erase(channel);
    }
    if (!is_wanted) return;
    const std::string topic = channels.at(channel - 1).topic;
    try {
      bus::ReaderOptions deep;
      deep.profile_suffix = "deep";
      auto reader = std::make_unique<bus::RawReader>(
          host.participant(), topic,
          [this, channel, topic, is_latched = bus::is_latched(host.participant(), topic)](
              std::span<const std::uint8_t> bytes, const bus::SampleInfo&) {
            take(channel, topic, is_latched, bytes);
          },
          deep);
      const std::lock_guard lock(mutex);
      if (!is_ending) readers[channel] = std::move(reader);
    } catch (const bus::BusError& error) {  // e.g. without permission for it
      const auto line =
          not_shown.add(topic, "not shown: " + std::string(error.what()), host.clock().monotonic_ns());
      if (line) host.log().warning(*line);
    }
  }
  void take(std::uint32_t channel, const std::string& topic, bool is_latched,
            std::span<const std::uint8_t> bytes) {
    const Message message{host.clock().utc_ns(),
                          std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end())};
    if (is_latched) {
      const std::string key = bus::key_of(topic, bytes).value_or("");
      const std::lock_guard lock(kept_mutex);
      auto& of_topic = kept[channel];
      if (of_topic.size() < kMostKept || of_topic.contains(key)) of_topic[key] = message;
    }
    server.publish(channel, message);
  }
  [[nodiscard]] std::vector<Message> kept_of(std::uint32_t channel) {
    const std::lock_guard lock(kept_mutex);
    std::vector<Message> out;
    const auto found = kept.find(channel);
    if (found == kept.end()) return out;
    for (const auto& [key, message] : found->second) out.push_back(message);
    return out;
  }

  void fill(ServiceStatus& status) {
    const WsServer::Status shown = server.status();
    status.counters.push_back({"clients", shown.clients});
    status.counters.push_back({"messages", shown.messages});
    status.counters.push_back({"messages_dropped", shown.dropped});
    if (shown.refused > 0) status.counters.push_back({"clients_refused", shown.refused});
    if (!shown.trouble.empty()) {
      status.state = ServiceState::degraded;
      status.text = shown.trouble;
    }
  }

  host::ServiceHost& host;
  const bool needs_token;
  const config::TokenBook tokens;
  const std::vector<Channel> channels;
  std::mutex kept_mutex;
  std::map<std::uint32_t, std::map<std::string, Message>> kept;  ///< latched, by channel and key
  std::mutex mutex;
  bool is_ending = false;
  std::map<std::uint32_t, std::unique_ptr<bus::RawReader>> readers;
  runtime::RefusalLog not_shown;
  WsServer server;
};

FoxgloveService::FoxgloveService(host::ServiceHost& host, const config::FoxgloveConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}
FoxgloveService::~FoxgloveService() = default;

}  // namespace fathom::foxglove
