#include "security/inspect.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "security/roles.hpp"

namespace fathom::security {
namespace {

namespace fs = std::filesystem;

bool same_topics(const std::vector<std::string>& written, std::span<const std::string_view> expected) {
  return std::set<std::string_view>(written.begin(), written.end()) ==
         std::set<std::string_view>(expected.begin(), expected.end());
}

Inspected inspect_authority(const std::string& name, const fs::path& file, TimeNs now) {
  Inspected out{name, {}, {}, true};
  out.validity = validity_of(read_certificate(file));
  if (const std::string ending = expiry_text(out.validity.until_ns, now); !ending.empty()) {
    out.fault = "The authority " + ending + ": make new ones with --force.";
    out.usable = now <= out.validity.until_ns;
  }
  return out;
}

/// What check_credentials() does not ask: whether the permissions are what this build's service needs.
std::string compare_permissions(const CredentialFolder& files, const std::string& name, TimeNs now) {
  const Role* role = find_role(name);
  if (role == nullptr) return "No service of this build has this name.";
  const fs::path ca = files.permissions_ca();
  const std::string place = files.permissions(name).string();
  const Grant grant = grant_from_xml(read_document(place, read_certificate(ca), now), place);
  const bool same =
      same_topics(grant.publishes, role->publishes) && same_topics(grant.subscribes, role->subscribes);
  return same ? "" : "Its permissions differ from this build's: renew it with --service " + name + ".";
}

Inspected inspect_identity(const CredentialFolder& files, const std::string& name, std::uint32_t domain,
                           TimeNs now) {
  Inspected out{name, {}, {}, true};
  try {
    const std::string place = files.certificate(name).string();
    out.validity = validity_of(read_certificate(place));
    const Credentials credentials = check_credentials(files.path().string(), name, domain, now);
    out.fault = compare_permissions(files, name, now);
    if (const std::string ending = expiry_text(credentials.validity.until_ns, now); !ending.empty()) {
      out.fault = "It " + ending + ": renew it with --service " + name + " or all with --rotate.";
    }
  } catch (const SecurityError& error) {
    out.fault = error.what();
    out.usable = false;
  }
  return out;
}

}  // namespace

bool Inspection::good() const {
  return std::all_of(items.begin(), items.end(), [](const Inspected& item) { return item.fault.empty(); });
}

Inspection inspect(const std::string& folder, TimeNs now) {
  const CredentialFolder files{fs::path(folder)};
  std::error_code error;
  if (!fs::is_directory(files.path(), error)) {
    throw SecurityError(folder + ": is no folder, expected credentials as fathom keygen makes");
  }
  Inspection out;
  out.items.push_back(inspect_authority("identity_ca", files.identity_ca(), now));
  out.items.push_back(inspect_authority("permissions_ca", files.permissions_ca(), now));
  out.vehicle = subject_of(read_certificate(files.identity_ca())).vehicle;
  out.authority_present = fs::exists(files.authority());
  std::set<std::string> names;
  for (const Role& role : roles()) names.emplace(role.name);
  for (const auto& entry : fs::directory_iterator(files.path())) {
    if (entry.is_directory() && fs::exists(entry.path() / "certificate.pem"))
      names.insert(entry.path().filename());
  }
  if (!out.items[1].usable) return out;  // then nothing that it signed can be opened
  out.domains = read_governance(files, read_certificate(files.permissions_ca()), now).domains;
  for (const std::string& name : names) {
    if (fs::exists(files.identity(name))) {
      out.items.push_back(inspect_identity(files, name, out.domains.first, now));
    } else {
      out.items.push_back(
          {name, {}, "There is no such identity: make it with --service " + name + ".", false});
    }
  }
  return out;
}

}  // namespace fathom::security
