#pragma once

#include <cstdint>
#include <string>

#include "security/documents.hpp"
#include "security/files.hpp"

namespace fathom::security {

/// A certificate that ends sooner than this is worth a word.
inline constexpr DurationNs kExpiryWarning = DurationNs{30} * 86400 * kNsPerSecond;

/// Credentials that passed every check that can be made without the network.
struct Credentials {
  CredentialFolder folder;
  std::string identity;
  Validity validity;  ///< the shorter of the certificate's and its authority's
};

/// The identity's files as a participant of `domain` needs them at `now`: there and readable, the key private
/// and of this certificate, the certificate and the signed documents valid and of these authorities, the
/// domain among the allowed. Throws SecurityError with the first thing that is wrong.
[[nodiscard]] Credentials check_credentials(const std::string& folder, const std::string& identity,
                                            std::uint32_t domain, TimeNs now);

/// The certificate in a PEM file; the text of a signed document; the governance of a folder, signed by its
/// permissions authority. Throw SecurityError naming the file.
[[nodiscard]] Certificate read_certificate(const std::filesystem::path& file);
[[nodiscard]] std::string read_document(const std::filesystem::path& file, const Certificate& authority,
                                        TimeNs now);
[[nodiscard]] Governance read_governance(const CredentialFolder& files, const Certificate& authority,
                                         TimeNs now);

/// "expires in 12 days (2026-03-01)" or "has expired on ..." when that is worth a word at `now`; else empty.
[[nodiscard]] std::string expiry_text(TimeNs until_ns, TimeNs now);

/// Names of identities become file names and parts of certificates: 1 to 64 letters, digits,
/// '_', '-', '.', not beginning with a dot.
[[nodiscard]] bool is_plain_name(const std::string& name);

}  // namespace fathom::security
