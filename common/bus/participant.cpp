#include "bus/participant.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <unistd.h>

#include "bus/detail/network/discovery.hpp"
#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/sample_type.hpp"
#include "bus/detail/security/security.hpp"
#include "bus/detail/versions/transports.hpp"
#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/detail/workarounds/scheduling.hpp"
#include "bus/interfaces.hpp"
#include "bus/option_error.hpp"

namespace fathom::bus {
namespace {

namespace dds = detail::dds;
namespace rtps = detail::rtps;
using detail::done;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

constexpr const char* kParticipantProfile = "fathom";

/// Numbers of the participants of this process. Fast DDS derives ports from them and by itself never gives
/// one out twice, so that a process that has created and destroyed many would leave the range in which peers
/// look for it.
class ParticipantNumbers {
 public:
  int take() {
    const std::lock_guard lock(mutex_);
    int number = 0;
    while (taken_.contains(number)) ++number;
    taken_.insert(number);
    return number;
  }
  void give_back(int number) {
    const std::lock_guard lock(mutex_);
    taken_.erase(number);
  }

 private:
  std::mutex mutex_;
  std::set<int> taken_;
};

ParticipantNumbers& participant_numbers() {
  static ParticipantNumbers numbers;  // per process, as the ports are
  return numbers;
}

std::string host_name() {
  std::array<char, 64> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return {};
  return name.data();
}

rtps::Locator_t locator(const std::string& what, const std::string& address) {
  rtps::Locator_t result;
  result.kind = LOCATOR_KIND_UDPv4;
  if (!rtps::IPLocator::isIPv4(address) || !rtps::IPLocator::setIPv4(result, address)) {
    throw OptionError(what + " '" + address + "': expected an IPv4 address such as 127.0.0.1");
  }
  return result;
}

bool loopback(const std::string& address) {
  return address.starts_with("127.");
}

constexpr std::string_view kLowPriorityMark = ";looks_on";

dds::DomainParticipantQos participant_qos(const ParticipantOptions& options,
                                          const std::string& profiles_dir) {
  dds::DomainParticipantQos qos;
  if (!done(dds::DomainParticipantFactory::get_instance()->get_participant_qos_from_profile(
          kParticipantProfile, qos))) {
    throw BusError(profiles_dir + ": the QoS profiles have no participant '" + kParticipantProfile + "'");
  }
  qos.name(options.name);
  std::string user = "host=" + host_name() + ";pid=" + std::to_string(getpid());
  if (!options.user_data.empty()) user += ";" + options.user_data;
  if (options.low_priority) user += kLowPriorityMark;
  qos.user_data().setValue(std::vector<rtps::octet>(user.begin(), user.end()));

  // The profile's transport is shared by everybody in this process who loads it: give interfaces to a copy.
  auto& transports = qos.transport().user_transports;
  const auto profile =
      transports.size() == 1 ? std::dynamic_pointer_cast<UDPv4TransportDescriptor>(transports[0]) : nullptr;
  if (!profile) throw BusError(profiles_dir + ": participant 'fathom': expected exactly one UDPv4 transport");
  auto transport = std::make_shared<UDPv4TransportDescriptor>(*profile);
  transport->interfaceWhiteList = options.interfaces;
  transports = {transport};
  qos.transport().use_builtin_transports = false;

  if (detail::uses_servers(options)) {
    detail::discover_through_servers(qos, options);
    return qos;
  }
  auto& builtin = qos.wire_protocol().builtin;
  for (const std::string& peer : options.peers) builtin.initialPeersList.push_back(locator("peer", peer));
  if (std::all_of(options.interfaces.begin(), options.interfaces.end(), loopback)) {
    // Naming the unicast locators leaves no multicast socket on the loopback interface.
    for (const std::string& interface : options.interfaces) {
      builtin.metatrafficUnicastLocatorList.push_back(locator("interface", interface));
    }
  } else {
    rtps::Locator_t multicast = locator("multicast group", "239.255.0.1");
    multicast.port = qos.wire_protocol().port.getMulticastPort(options.domain);
    builtin.initialPeersList.push_back(multicast);
  }
  return qos;
}

Peer to_peer(const detail::Announcement& announcement) {
  Peer peer;
  peer.name = announcement.name;
  peer.offers_identity = announcement.offers_identity;
  const std::string& text = announcement.user_data;
  const std::size_t host = text.find("host=");
  const std::size_t pid = text.find(";pid=");
  if (host != 0 || pid == std::string::npos) return peer;
  peer.host = text.substr(5, pid - 5);
  peer.pid = static_cast<std::uint32_t>(std::strtoul(text.c_str() + pid + 5, nullptr, 10));
  peer.low_priority = text.ends_with(kLowPriorityMark);
  return peer;
}

}  // namespace

Participant::Impl::Impl(const ParticipantOptions& options) {
  detail::capture_dds_log();
  if (options.name.empty() || options.name.size() > 255) {
    throw BusError("participant name '" + options.name + "': expected 1 to 255 bytes");
  }
  if (options.domain > 232) {
    throw BusError("domain " + std::to_string(options.domain) + ": expected 0 to 232");
  }
  check_interfaces(options.interfaces);
  if (!options.security.folder.empty() && detail::uses_servers(options)) {
    throw BusError(
        "discovery servers and security: expected only one of them, Fast DDS 2.9 aborts with both");
  }
  const std::string profiles_dir = detail::find_profiles_dir(options.profiles_dir);
  detail::load_profiles(profiles_dir);
  dds::DomainParticipantQos qos = participant_qos(options, profiles_dir);
  auto& sockets = qos.transport().user_transports.front();
  sockets = std::make_shared<detail::TransportDescriptor>(
      sockets, low_priority_peers_, delivery_watch, acknowledgements,
      [this](const std::string& address) { refuse_datagram(address); });
  if (!options.security.folder.empty()) {
    credentials = detail::credentials_of(options);
    detail::protect(qos, *credentials);
    errors_.emplace([this](const std::string& message) { on_dds_error(message); });
  }
  if (!options.discovery_listen.empty()) detail::outlast_predecessor(qos, options.discovery_listen);
  number_ = participant_numbers().take();
  qos.wire_protocol().participant_id = number_;

  auto* factory = dds::DomainParticipantFactory::get_instance();
  {
    const detail::ScopedChores chores;
    if (!options.low_priority) samples_as = chores.before();
    participant = factory->create_participant(options.domain, qos, this, dds::StatusMask::none());
  }
  if (participant != nullptr) {
    publisher = participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber = participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  if (publisher == nullptr || subscriber == nullptr) {
    const std::string why = detail::last_dds_error();
    close();  // half made, it would go on calling this listener
    throw BusError("participant '" + options.name + "' on domain " + std::to_string(options.domain) +
                   ": Fast DDS could not create it" + why);
  }
}

Participant::Impl::~Impl() {
  close();
}

void Participant::Impl::close() {
  if (participant != nullptr) {
    participant->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }
  participant_numbers().give_back(number_);
}

dds::Topic* Participant::Impl::topic(const detail::TopicOps& ops) {
  const std::lock_guard lock(mutex_);
  dds::Topic*& topic = topics_[ops.topic];
  if (topic != nullptr) return topic;
  const dds::TypeSupport type(new detail::SampleType(ops));
  if (done(type.register_type(participant))) {
    topic = participant->create_topic(ops.topic, ops.type_name, dds::TOPIC_QOS_DEFAULT);
  }
  if (topic == nullptr) {
    throw BusError("topic " + std::string(ops.topic) + ": Fast DDS could not create it" +
                   detail::last_dds_error());
  }
  types_[ops.topic] = ops.type_name;
  return topic;
}

void Participant::Impl::check_types(const std::string& topic) {
  std::string type;
  {
    const std::lock_guard lock(mutex_);
    const auto found = types_.find(topic);
    if (found == types_.end()) return;
    type = found->second;
  }
  for (const std::string& conflict : peers.type_conflicts(topic, type)) {
    std::string text = conflict;
    text.append(" differs from ours, '").append(type).append("': they never meet");
    events.report(BusEventKind::incompatible_qos, topic, conflict, text);
  }
}

void Participant::Impl::writer_matched(const WriterGuid& guid, const std::string& topic) {
  events.recovered(BusEventKind::writer_lost, topic, peers.name(guid));
}

void Participant::Impl::writer_unmatched(const WriterGuid& guid, const std::string& topic) {
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(mutex_);
  // Fast DDS unmatches the writers of a dropped participant immediately before it reports the drop; what was
  // unmatched earlier had been deleted.
  std::erase_if(unmatched_, [&](const Unmatched& old) { return now - old.when > std::chrono::seconds(1); });
  unmatched_.push_back({guid, topic, now});
}

void Participant::Impl::participant_dropped(const detail::GuidPrefix& prefix) {
  std::vector<Unmatched> lost;
  {
    const auto now = std::chrono::steady_clock::now();
    const std::lock_guard lock(mutex_);
    for (const Unmatched& entry : unmatched_) {
      if (detail::prefix_of(entry.guid) == prefix && now - entry.when <= std::chrono::seconds(1)) {
        lost.push_back(entry);
      }
    }
  }
  for (const Unmatched& writer : lost) {
    const std::string name = peers.name(writer.guid);
    events.report(BusEventKind::writer_lost, writer.topic, name,
                  "writer of " + name + " fell silent and was given up");
  }
}

void Participant::Impl::refuse_datagram(const std::string& address) {
  // The address is hearsay, and there may be many of them: reported once.
  events.report(
      BusEventKind::malformed_datagram, "", "",
      "one from " + address + " would have ended or blocked this service; left out, and those that follow");
}

void Participant::Impl::participant_seen(const detail::GuidPrefix& who,
                                         const detail::Announcement& announcement) {
  acknowledgements->seen(who);
  const Peer peer = to_peer(announcement);
  if (peer.low_priority) {
    low_priority_peers_->seen(who, announcement.samples_at);
  } else {
    low_priority_peers_->gone(who);
  }
  if (credentials) {
    meet(who, peer, announcement);  // one of the peers when it has proved who it is
  } else {
    peers.participant_seen(who, peer);
  }
}

void Participant::Impl::participant_gone(const detail::GuidPrefix& who, bool fell_silent) {
  low_priority_peers_->gone(who);
  delivery_watch->gone(who);
  acknowledgements->gone(who);
  if (fell_silent) participant_dropped(who);
  peers.participant_gone(who);
  if (credentials) part(who);
  const std::lock_guard lock(mutex_);
  std::erase_if(unmatched_, [&](const Unmatched& entry) { return detail::prefix_of(entry.guid) == who; });
}

void Participant::Impl::writer_seen(const WriterGuid& guid, const detail::RemoteEndpoint& writer) {
  peers.writer_seen(guid, writer);
  check_types(writer.topic);
}

void Participant::Impl::writer_gone(const WriterGuid& guid) {
  peers.writer_gone(guid);
}

void Participant::Impl::reader_seen(const WriterGuid& guid, const detail::RemoteEndpoint& reader) {
  peers.reader_seen(guid, reader);
  check_types(reader.topic);
}

void Participant::Impl::reader_gone(const WriterGuid& guid) {
  peers.reader_gone(guid);
}

Participant::Participant(const ParticipantOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Participant::~Participant() = default;

BusCounters Participant::counters() const {
  impl_->judge_waiting();
  return impl_->events.counters();
}

void Participant::on_event(std::function<void(const BusEvent&)> handler) {
  impl_->events.set_handler(std::move(handler));
}

std::optional<Peer> Participant::peer(const WriterGuid& writer) const {
  return impl_->peers.peer(writer);
}
std::string Participant::writer_name(const WriterGuid& writer) const {
  return impl_->peers.name(writer);
}
std::vector<Peer> Participant::peers() const {
  return impl_->peers.present();
}
std::vector<Stranger> Participant::strangers() const {
  return impl_->strangers.present();
}
std::optional<TimeNs> Participant::credentials_until_ns() const {
  if (!impl_->credentials) return std::nullopt;
  return impl_->credentials->validity.until_ns;
}
std::optional<DurationNs> Participant::longest_silence_ns() const {
  if (!impl_->credentials) return std::nullopt;
  // The others count from the last that they heard, which may be two signs of life ago.
  constexpr int kHeardBefore_s = 2;
  return (detail::kProtectedLease_s - kHeardBefore_s) * kNsPerSecond;
}
std::string Participant::credentials_warning(TimeNs now) const {
  if (!impl_->credentials) return {};
  const std::string ending = security::expiry_text(impl_->credentials->validity.until_ns, now);
  return ending.empty() ? "" : "identity " + impl_->credentials->identity + " " + ending;
}

}  // namespace fathom::bus
