#include "console/http/tls.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include "security/credentials.hpp"

namespace fathom::console {
namespace {

constexpr DurationNs kDayNs = 24LL * 3600 * kNsPerSecond;

/// The newest complaint of the library, in its words; the queue is empty afterwards.
std::string library_complaint() {
  const unsigned long code = ERR_peek_last_error();
  ERR_clear_error();
  const char* words = code == 0 ? nullptr : ERR_reason_error_string(code);
  return words == nullptr ? "not understood" : words;
}

/// A passphrase would be asked for on a terminal that nobody watches.
int no_passphrase(char* /*to*/, int /*size*/, int /*writing*/, void* asked) {
  *static_cast<bool*>(asked) = true;
  return -1;
}

void need_readable(TlsError::File kind, const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || access(path.c_str(), R_OK) != 0) {
    throw TlsError(kind, path, std::string(std::strerror(errno)) + ", expected a PEM file that can be read");
  }
  if (!S_ISREG(status.st_mode)) throw TlsError(kind, path, "is no file, expected a PEM file");
  if (kind == TlsError::File::key && (status.st_mode & S_IRWXO) != 0) {
    throw TlsError(kind, path, "everyone may read or write it, expected mode 0600 or 0640");
  }
}

}  // namespace

TlsIdentity TlsIdentity::load(const std::string& certificate_file, const std::string& key_file) {
  using File = TlsError::File;
  need_readable(File::certificate, certificate_file);
  need_readable(File::key, key_file);
  ERR_clear_error();
  TlsIdentity out;
  out.context_ = {SSL_CTX_new(TLS_server_method()), SSL_CTX_free};
  SSL_CTX* context = out.context_.get();
  if (context == nullptr) throw std::runtime_error("TLS: OpenSSL gave no context: " + library_complaint());
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  // Sessions are resumed by tickets, which live with the browsers: what is kept here does not grow.
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER |
                                SSL_MODE_RELEASE_BUFFERS);
  bool asked = false;
  SSL_CTX_set_default_passwd_cb(context, no_passphrase);
  SSL_CTX_set_default_passwd_cb_userdata(context, &asked);

  if (SSL_CTX_use_certificate_chain_file(context, certificate_file.c_str()) != 1) {
    throw TlsError(File::certificate, certificate_file,
                   library_complaint() + ", expected a certificate in PEM, its chain behind it");
  }
  const int loaded = SSL_CTX_use_PrivateKey_file(context, key_file.c_str(), SSL_FILETYPE_PEM);
  SSL_CTX_set_default_passwd_cb_userdata(context, nullptr);
  SSL_CTX_set_default_passwd_cb(context, nullptr);
  if (asked)
    throw TlsError(File::key, key_file, "has a passphrase, expected a private key in PEM without one");
  if (loaded != 1) {
    // With a key of the same kind the library notices here already that the two do not belong together.
    const bool mismatch = ERR_GET_REASON(ERR_peek_last_error()) == X509_R_KEY_VALUES_MISMATCH ||
                          ERR_GET_REASON(ERR_peek_last_error()) == X509_R_KEY_TYPE_MISMATCH;
    const std::string complaint = library_complaint();
    throw TlsError(File::key, key_file,
                   mismatch
                       ? "is not the key of " + certificate_file + ", expected the one that it was made with"
                       : complaint + ", expected a private key in PEM");
  }
  if (SSL_CTX_check_private_key(context) != 1) {
    ERR_clear_error();
    throw TlsError(File::key, key_file,
                   "is not the key of " + certificate_file + ", expected the one that it was made with");
  }

  X509* leaf = SSL_CTX_get0_certificate(context);
  out.valid_from_ns_ = security::instant_of(X509_get0_notBefore(leaf));
  out.valid_until_ns_ = security::instant_of(X509_get0_notAfter(leaf));
  STACK_OF(X509)* chain = nullptr;
  SSL_CTX_get0_chain_certs(context, &chain);
  for (int i = 0; i < (chain == nullptr ? 0 : sk_X509_num(chain)); ++i) {
    const X509* link = sk_X509_value(chain, i);
    out.valid_from_ns_ = std::max(out.valid_from_ns_, security::instant_of(X509_get0_notBefore(link)));
    out.valid_until_ns_ = std::min(out.valid_until_ns_, security::instant_of(X509_get0_notAfter(link)));
  }
  return out;
}

std::optional<ValidityNote> validity_note(TimeNs valid_from_ns, TimeNs valid_until_ns, TimeNs utc_ns) {
  if (utc_ns < valid_from_ns) {
    return ValidityNote{false, "The TLS certificate is not valid before " + to_iso8601(valid_from_ns, 0) +
                                   "; is this host's clock right?"};
  }
  if (utc_ns >= valid_until_ns) {
    return ValidityNote{false, "The TLS certificate expired at " + to_iso8601(valid_until_ns, 0) +
                                   "; browsers refuse it. Replace it and restart the console."};
  }
  const DurationNs left_ns = valid_until_ns - utc_ns;
  if (left_ns > security::kExpiryWarning) return std::nullopt;
  return ValidityNote{true, "The TLS certificate expires in " + std::to_string(left_ns / kDayNs) +
                                " days, at " + to_iso8601(valid_until_ns, 0) +
                                "; replace it and restart the console."};
}

}  // namespace fathom::console
