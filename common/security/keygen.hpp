#pragma once

#include <string>
#include <vector>

#include "security/credentials.hpp"

namespace fathom::security {

struct KeygenOptions {
  std::string folder;
  std::string vehicle = "auv";
  Domains domains;
  MessageProtection protection = MessageProtection::encrypt;
  int days = 365;        ///< that identities hold
  int ca_days = 3650;    ///< that the authorities hold
  bool replace = false;  ///< authorities that exist already
};

/// Makes two authorities, the governance and every identity of roles(). Throws SecurityError; without
/// `replace` also when the folder has an authority already, before anything is written.
void make_credentials(const KeygenOptions& options, TimeNs now);

/// New keys, certificates and permissions, by the authorities in the folder, for the identities named, or all
/// of roles() when none is. Each takes its predecessor's place at once. Throws SecurityError.
void renew_identities(const std::string& folder, const std::vector<std::string>& names, int days, TimeNs now);

}  // namespace fathom::security
