#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "security/pki.hpp"

namespace fathom::security {

/// DDS domains, both ends included.
struct Domains {
  std::uint32_t first = 0;
  std::uint32_t last = 230;
  [[nodiscard]] bool hold(std::uint32_t domain) const { return first <= domain && domain <= last; }
};

/// What protects each message as a whole, besides the encryption of samples.
enum class MessageProtection : std::uint8_t {
  sign,     ///< nobody can forge or change one; who writes to whom can be seen
  encrypt,  ///< nor read what is around the samples
};

/// Rules that every participant of the vehicle keeps (DDS Security 1.1, domain governance): who has not
/// proved an identity is not spoken to, samples and discovery are encrypted, topics are read and written by
/// permission only.
[[nodiscard]] std::string governance_xml(const Domains& domains, MessageProtection protection);

struct Governance {
  Domains domains;
  MessageProtection protection = MessageProtection::sign;
};
/// Throws SecurityError naming `place`.
[[nodiscard]] Governance governance_from_xml(const std::string& xml, const std::string& place);

/// What one identity may do (DDS Security 1.1, permissions); everything else is denied.
struct Grant {
  std::string name;
  std::string subject;  ///< subject_text() of the certificate
  Validity validity;
  Domains domains;
  std::vector<std::string> publishes;
  std::vector<std::string> subscribes;
};
[[nodiscard]] std::string permissions_xml(const Grant& grant);
/// Throws SecurityError naming `place`.
[[nodiscard]] Grant grant_from_xml(const std::string& xml, const std::string& place);

}  // namespace fathom::security
