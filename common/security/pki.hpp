#pragma once

#include <memory>
#include <string>

#include "base/time.hpp"
#include "security/error.hpp"

struct asn1_string_st;
struct evp_pkey_st;
struct x509_st;

namespace fathom::security {

/// A private key on the curve P-256.
struct Key {
  std::shared_ptr<evp_pkey_st> handle;
};

/// An X.509 certificate.
struct Certificate {
  std::shared_ptr<x509_st> handle;
};

/// Whom a certificate names. On the wire: CN=name, OU=vehicle, O=fathom.
struct Subject {
  std::string vehicle;
  std::string name;
};

/// From and until when a certificate holds, UTC. Whole seconds.
struct Validity {
  TimeNs from_ns = 0;
  TimeNs until_ns = 0;
};

/// All functions throw SecurityError. `place` is the file that the message names.

[[nodiscard]] Key generate_key();
/// Who signs others; signed by itself.
[[nodiscard]] Certificate make_authority(const Key& key, const Subject& subject, const Validity& validity);
[[nodiscard]] Certificate issue(const Key& key, const Subject& subject, const Validity& validity,
                                const Key& authority_key, const Certificate& authority);

[[nodiscard]] std::string to_pem(const Key& key);
[[nodiscard]] std::string to_pem(const Certificate& certificate);
[[nodiscard]] Key key_from_pem(const std::string& pem, const std::string& place);
[[nodiscard]] Certificate certificate_from_pem(const std::string& pem, const std::string& place);

/// Dates beyond what 64 bits of nanoseconds hold (the year 2262) count as the last that they do.
[[nodiscard]] TimeNs instant_of(const asn1_string_st* time);
[[nodiscard]] Validity validity_of(const Certificate& certificate);
[[nodiscard]] Subject subject_of(const Certificate& certificate);
/// As permissions name it: RFC 2253, e.g. "CN=fusion,OU=auv,O=fathom".
[[nodiscard]] std::string subject_text(const Certificate& certificate);
[[nodiscard]] bool belong_together(const Key& key, const Certificate& certificate);
/// Why the authority does not vouch for the certificate at this instant, in words; empty when it does.
[[nodiscard]] std::string distrust(const Certificate& certificate, const Certificate& authority, TimeNs now);

/// The text with the authority's signature beside it: S/MIME, PKCS #7 detached, as DDS Security asks for.
[[nodiscard]] std::string sign_document(const std::string& text, const Key& authority_key,
                                        const Certificate& authority);
/// The text of a signed document, when this authority signed it and its certificate holds at this instant.
[[nodiscard]] std::string open_document(const std::string& document, const Certificate& authority, TimeNs now,
                                        const std::string& place);

}  // namespace fathom::security
