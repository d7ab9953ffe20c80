#include "security/keygen.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>

#include "base/is_name.hpp"
#include "security/roles.hpp"

namespace fathom::security {
namespace {

namespace fs = std::filesystem;

constexpr DurationNs kDay = 86400 * kNsPerSecond;
// Clocks of a vehicle's machines differ, and some wake up in the past.
constexpr DurationNs kBackdated = kDay;
// Dates of permissions are read as local time: they enclose the certificate's, whatever the time zone.
constexpr DurationNs kTimeZones = kDay;

struct Authority {
  Key key;
  Certificate certificate;
};

/// What identities are made with.
struct Authorities {
  Authority identity;
  Authority permissions;
  std::string vehicle;
  Domains domains;
};

void make_folder(const fs::path& folder, mode_t mode) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || chmod(folder.c_str(), mode) != 0) {
    throw WriteError(folder.string() + ": cannot be made (" +
                     (error ? error.message() : std::strerror(errno)) +
                     "), expected a place that may be written to");
  }
}

Authority make(const std::string& name, const KeygenOptions& options, TimeNs now) {
  const Key key = generate_key();
  return {key,
          make_authority(key, {options.vehicle, name}, {now - kBackdated, now + options.ca_days * kDay})};
}

Authority load(const fs::path& certificate, const fs::path& key) {
  Authority out{key_from_pem(read_private(key), key.string()), read_certificate(certificate)};
  if (!belong_together(out.key, out.certificate)) {
    throw SecurityError(key.string() + ": belongs to another certificate, expected the key of " +
                        certificate.string());
  }
  return out;
}

Authorities load(const CredentialFolder& files, TimeNs now) {
  Authorities out{load(files.identity_ca(), files.identity_ca_key()),
                  load(files.permissions_ca(), files.permissions_ca_key()),
                  "",
                  {}};
  out.vehicle = subject_of(out.identity.certificate).vehicle;
  out.domains = read_governance(files, out.permissions.certificate, now).domains;
  return out;
}

std::vector<std::string> strings(std::span<const std::string_view> views) {
  return {views.begin(), views.end()};
}

/// Beside `folder` first, then in its place, so that nobody meets a key without its certificate.
void make_identity(const fs::path& folder, const Role& role, const Authorities& by, int days, TimeNs now) {
  const fs::path fresh = folder.string() + ".new";
  fs::remove_all(fresh);  // left by a run that was cut off
  make_folder(fresh, 0755);
  const Validity validity{now - kBackdated, now + days * kDay};
  const Key key = generate_key();
  const Certificate certificate =
      issue(key, {by.vehicle, std::string(role.name)}, validity, by.identity.key, by.identity.certificate);
  write_private(fresh / "key.pem", to_pem(key));
  write_text(fresh / "certificate.pem", to_pem(certificate));
  const std::string permissions =
      permissions_xml({std::string(role.name),
                       subject_text(certificate),
                       {validity.from_ns - kTimeZones, validity.until_ns + kTimeZones},
                       by.domains,
                       strings(role.publishes),
                       strings(role.subscribes)});
  write_text(fresh / "permissions.xml", permissions);
  write_text(fresh / "permissions.smime",
             sign_document(permissions, by.permissions.key, by.permissions.certificate));
  const bool exists = fs::exists(folder);
  const int moved = exists ? renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE)
                           : rename(fresh.c_str(), folder.c_str());
  if (moved != 0) {
    throw WriteError(folder.string() + ": cannot be replaced (" + std::strerror(errno) +
                     "), expected a folder that may be written to");
  }
  if (exists) fs::remove_all(fresh);
}

void check_days(int days, const Certificate& authority, TimeNs now, const fs::path& file) {
  const auto left = (validity_of(authority).until_ns - now) / kDay;
  if (days <= left) return;
  throw SecurityError(file.string() + ": holds for " + std::to_string(left) +
                      " more days, expected at least the " + std::to_string(days) + " asked for an identity");
}

}  // namespace

void make_credentials(const KeygenOptions& options, TimeNs now) {
  if (!is_name(options.vehicle))
    throw SecurityError("vehicle '" + options.vehicle + "': expected " + kNameForm);
  if (options.days > options.ca_days) {
    throw SecurityError("days " + std::to_string(options.days) + ": expected at most the " +
                        std::to_string(options.ca_days) + " that the authorities hold");
  }
  const CredentialFolder files(options.folder);
  for (const fs::path& file : {files.identity_ca(), files.permissions_ca(), files.authority()}) {
    if (!options.replace && fs::exists(file)) {
      throw SecurityError(
          file.string() +
          ": exists, expected a new folder (--rotate renews identities, --force makes new authorities "
          "and shuts out whoever has the old ones)");
    }
  }
  make_folder(files.path(), 0755);
  make_folder(files.authority(), 0700);
  const Authorities by{make("identity_ca", options, now), make("permissions_ca", options, now),
                       options.vehicle, options.domains};
  write_private(files.identity_ca_key(), to_pem(by.identity.key));
  write_private(files.permissions_ca_key(), to_pem(by.permissions.key));
  write_text(files.identity_ca(), to_pem(by.identity.certificate));
  write_text(files.permissions_ca(), to_pem(by.permissions.certificate));
  const std::string governance = governance_xml(options.domains, options.protection);
  write_text(files.path() / "governance.xml", governance);
  write_text(files.governance(), sign_document(governance, by.permissions.key, by.permissions.certificate));
  for (const Role& role : roles()) {
    make_identity(files.identity(std::string(role.name)), role, by, options.days, now);
  }
}

void renew_identities(const std::string& folder, const std::vector<std::string>& names, int days,
                      TimeNs now) {
  const CredentialFolder files(folder);
  std::vector<const Role*> wanted;
  for (const std::string& name : names) {
    wanted.push_back(find_role(name));
    if (wanted.back() != nullptr) continue;
    std::string known;
    for (const Role& role : roles()) known.append(known.empty() ? "" : ", ").append(role.name);
    std::string text = "service '";
    text.append(name).append("': nobody has this name, expected one of ").append(known);
    throw SecurityError(text);
  }
  if (names.empty()) {
    for (const Role& role : roles()) wanted.push_back(&role);
  }
  const Authorities by = load(files, now);
  check_days(days, by.identity.certificate, now, files.identity_ca());
  check_days(days, by.permissions.certificate, now, files.permissions_ca());
  for (const Role* role : wanted)
    make_identity(files.identity(std::string(role->name)), *role, by, days, now);
}

}  // namespace fathom::security
