#include "bus/detail/security/security.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/clock.hpp"
#include "bus/detail/participant_impl.hpp"
#include "bus/detail/workarounds/dds_log.hpp"

#if !HAVE_SECURITY
#error "This Fast DDS was built without DDS Security, which the vehicle network needs."
#endif

namespace fathom::bus {
namespace {

namespace dds = detail::dds;
namespace rtps = detail::rtps;

// Names are the stranger's own: after so many, the rest is reported as one.
constexpr std::size_t kReportedByName = 16;

std::string address_of(const detail::Announcement& announcement) {
  const auto& locators = announcement.discovery_at;
  return locators.empty() ? "" : rtps::IPLocator::toIPv4string(locators[0]);
}

}  // namespace

security::Credentials detail::credentials_of(const ParticipantOptions& options) {
  const std::string& identity = options.security.identity.empty() ? options.name : options.security.identity;
  try {
    return security::check_credentials(options.security.folder, identity, options.domain,
                                       SystemClock().utc_ns());
  } catch (const security::SecurityError& error) {
    throw CredentialsError(error.what());
  }
}

void detail::protect(dds::DomainParticipantQos& qos, const security::Credentials& credentials) {
  const security::CredentialFolder& files = credentials.folder;
  const auto set = [&qos](const std::string& name, const std::string& value) {
    qos.properties().properties().emplace_back("dds.sec." + name, value);
  };
  const auto file = [](const std::filesystem::path& path) { return "file://" + path.string(); };
  set("auth.plugin", "builtin.PKI-DH");
  set("auth.builtin.PKI-DH.identity_ca", file(files.identity_ca()));
  set("auth.builtin.PKI-DH.identity_certificate", file(files.certificate(credentials.identity)));
  set("auth.builtin.PKI-DH.private_key", file(files.key(credentials.identity)));
  set("access.plugin", "builtin.Access-Permissions");
  set("access.builtin.Access-Permissions.permissions_ca", file(files.permissions_ca()));
  set("access.builtin.Access-Permissions.governance", file(files.governance()));
  set("access.builtin.Access-Permissions.permissions", file(files.permissions(credentials.identity)));
  set("crypto.plugin", "builtin.AES-GCM-GMAC");
  qos.wire_protocol().builtin.discovery_config.leaseDuration = {kProtectedLease_s, 0};
}

void Participant::Impl::report(const Stranger& stranger) {
  std::string subject = stranger.guid;
  {
    const std::lock_guard lock(strangers_mutex_);
    if (reported_strangers_.size() < kReportedByName) reported_strangers_.insert(subject);
    if (!reported_strangers_.contains(subject)) subject = "more";
  }
  events.report(BusEventKind::stranger_refused, "", subject, to_string(stranger) + " and is not spoken to");
}

void Participant::Impl::meet(const detail::GuidPrefix& prefix, const Peer& peer,
                             const detail::Announcement& announcement) {
  const auto proven =
      strangers.announced(prefix, peer, address_of(announcement), announcement.offers_identity);
  if (proven) peers.participant_seen(prefix, *proven);
}

void Participant::Impl::part(const detail::GuidPrefix& prefix) {
  const auto stranger = strangers.gone(prefix);
  if (stranger) events.recovered(BusEventKind::stranger_refused, "", stranger->guid);
}

void Participant::Impl::onParticipantAuthentication(dds::DomainParticipant*,
                                                    rtps::ParticipantAuthenticationInfo&& info) {
  const detail::GuidPrefix prefix = detail::prefix_of(detail::to_guid(info.guid));
  if (info.status == rtps::ParticipantAuthenticationInfo::AUTHORIZED_PARTICIPANT) {
    const auto peer = strangers.admitted(prefix);
    if (peer) peers.participant_seen(prefix, *peer);
    events.recovered(BusEventKind::stranger_refused, "", detail::hex(prefix));
    return;
  }
  report(strangers.refused(prefix, "could not prove an identity of this vehicle"));
}

void Participant::Impl::on_dds_error(const std::string& message) {
  if (message.starts_with("Error checking creation of local ")) {
    const std::lock_guard lock(strangers_mutex_);
    denied_ = true;
  }
  const auto denial = detail::parse_denial(message);
  if (!denial) return;
  if (denial->whole) {
    report(strangers.refused(denial->who, "has no permissions that this vehicle gave"));
    return;
  }
  WriterGuid guid{};
  std::copy(denial->who.begin(), denial->who.end(), guid.begin());
  const std::string name = peers.name(guid);
  events.report(BusEventKind::permission_refused, denial->topic,
                name + (denial->writes ? " writes" : " reads"),
                detail::cleaned(name) + " tried to " + (denial->writes ? "write" : "read") +
                    " what its permissions do not allow, and is not heard");
}

void Participant::Impl::judge_waiting() {
  for (const Stranger& stranger : strangers.overdue()) report(stranger);
  for (const Stranger& stranger : strangers.forgotten())
    events.recovered(BusEventKind::stranger_refused, "", stranger.guid);
}

std::string Participant::Impl::why_not(const std::string& topic) {
  std::string error = detail::last_dds_error();  // every error until now has been heard then
  const std::lock_guard lock(strangers_mutex_);
  if (!std::exchange(denied_, false)) return error;
  return ": the permissions of identity '" + credentials->identity + "' in " +
         credentials->folder.path().string() + " do not allow " + topic +
         ", expected permissions that do (fathom keygen --check compares them)";
}

}  // namespace fathom::bus
