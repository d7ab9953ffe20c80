#pragma once

#include <string>
#include <vector>

#include "security/credentials.hpp"

namespace fathom::security {

/// What an inspection found out about one authority or identity.
struct Inspected {
  std::string name;   ///< "identity_ca", "permissions_ca", or the identity's
  Validity validity;  ///< zero when the certificate cannot be read
  std::string fault;  ///< what is wrong, one sentence; empty: nothing
  /// False where the fault is only that the end is near.
  bool usable = true;
};

struct Inspection {
  std::string vehicle;
  Domains domains;
  std::vector<Inspected> items;
  bool authority_present = false;  ///< the authorities' own keys lie in the folder
  [[nodiscard]] bool good() const;
};

/// Every authority and identity in the folder, at `now`: as check_credentials(), besides an end within
/// kExpiryWarning, identities of roles() that are missing and permissions that differ from this build's.
/// Throws SecurityError when the folder itself, its authorities or its governance make no sense.
[[nodiscard]] Inspection inspect(const std::string& folder, TimeNs now);

}  // namespace fathom::security
