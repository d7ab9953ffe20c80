#include "security/credentials.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

namespace fathom::security {
namespace {

std::string day(TimeNs utc) {
  return to_iso8601(utc, 0).substr(0, 10);
}

void check_dates(const Validity& validity, TimeNs now, const std::string& place, const std::string& what) {
  if (now < validity.from_ns) {
    throw SecurityError(place + ": " + what + " holds from " + day(validity.from_ns) +
                        ", and this host's clock says " + to_iso8601(now, 0) +
                        ", expected a clock that is set");
  }
  if (now > validity.until_ns) {
    throw SecurityError(place + ": " + what + " expired on " + day(validity.until_ns) +
                        ", expected one that holds (fathom keygen --rotate makes new ones)");
  }
}

Certificate authority(const std::filesystem::path& file, TimeNs now) {
  Certificate certificate = read_certificate(file);
  check_dates(validity_of(certificate), now, file.string(), "the authority");
  return certificate;
}

void check_domain(const Domains& domains, std::uint32_t domain, const std::string& place) {
  // Outside of the governance's domains Fast DDS would quietly protect nothing.
  if (domains.hold(domain)) return;
  throw SecurityError(place + ": is for domains " + std::to_string(domains.first) + " to " +
                      std::to_string(domains.last) + ", expected domain " + std::to_string(domain) +
                      " among them");
}

}  // namespace

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return c < 128 && (std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.');
         });
}

Certificate read_certificate(const std::filesystem::path& file) {
  return certificate_from_pem(read_text(file), file.string());
}

std::string read_document(const std::filesystem::path& file, const Certificate& authority, TimeNs now) {
  return open_document(read_text(file), authority, now, file.string());
}

Governance read_governance(const CredentialFolder& files, const Certificate& authority, TimeNs now) {
  return governance_from_xml(read_document(files.governance(), authority, now), files.governance().string());
}

std::string expiry_text(TimeNs until_ns, TimeNs now) {
  constexpr DurationNs kDay = 86400 * kNsPerSecond;
  if (now > until_ns) return "has expired on " + day(until_ns);
  if (until_ns - now > kExpiryWarning) return {};
  const auto days = (until_ns - now) / kDay;
  return "expires in " + std::to_string(days) + (days == 1 ? " day (" : " days (") + day(until_ns) + ")";
}

Credentials check_credentials(const std::string& folder, const std::string& identity, std::uint32_t domain,
                              TimeNs now) {
  const CredentialFolder files(std::filesystem::absolute(folder));
  std::error_code error;
  if (!std::filesystem::is_directory(files.path(), error)) {
    throw SecurityError(folder + ": is no folder, expected credentials as fathom keygen makes");
  }
  if (!is_plain_name(identity) || !std::filesystem::is_directory(files.identity(identity), error)) {
    const bool hidden = error && error != std::errc::no_such_file_or_directory;
    throw SecurityError(folder + ": has no identity '" + identity + "'" +
                        (hidden ? " that can be read (" + error.message() + ")" : "") +
                        ", expected one as fathom keygen --service makes");
  }
  const std::string place = files.certificate(identity).string();
  const Certificate certificate = read_certificate(place);
  const Key key = key_from_pem(read_private(files.key(identity)), files.key(identity).string());
  if (!belong_together(key, certificate)) {
    throw SecurityError(files.key(identity).string() +
                        ": belongs to another certificate, expected the key of " + place);
  }
  const Validity validity = validity_of(certificate);
  check_dates(validity, now, place, "the identity");
  const Certificate identity_ca = authority(files.identity_ca(), now);
  if (const std::string why = distrust(certificate, identity_ca, now); !why.empty()) {
    throw SecurityError(place + ": is not vouched for by " + files.identity_ca().string() + " (" + why +
                        "), expected a certificate that this authority issued");
  }

  const Certificate permissions_ca = authority(files.permissions_ca(), now);
  const Governance governance = read_governance(files, permissions_ca, now);
  check_domain(governance.domains, domain, files.governance().string());

  const std::string permissions_place = files.permissions(identity).string();
  const Grant grant =
      grant_from_xml(read_document(permissions_place, permissions_ca, now), permissions_place);
  if (grant.subject != subject_text(certificate)) {
    throw SecurityError(permissions_place + ": is for '" + grant.subject + "', expected '" +
                        subject_text(certificate) + "', whom the certificate names");
  }
  check_dates(grant.validity, now, permissions_place, "the permission");
  check_domain(grant.domains, domain, permissions_place);
  const TimeNs until_ns = std::min({validity.until_ns, validity_of(identity_ca).until_ns,
                                    validity_of(permissions_ca).until_ns, grant.validity.until_ns});
  return {files, identity, {validity.from_ns, until_ns}};
}

}  // namespace fathom::security
