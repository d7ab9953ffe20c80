#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/time.hpp"

struct ssl_ctx_st;

namespace fathom::console {

/// A certificate or key that cannot be used; the message says which file, what was wrong and what was
/// expected.
class TlsError : public std::runtime_error {
 public:
  enum class File { certificate, key };
  TlsError(File file, const std::string& path, const std::string& problem)
      : std::runtime_error(path + ": " + problem), file_(file) {}
  [[nodiscard]] File file() const { return file_; }

 private:
  File file_;
};

/// By what the console proves to browsers that it is who they asked for: a certificate with its chain, and
/// the key to it. Shared by all connections.
class TlsIdentity {
 public:
  /// Both files are PEM. The key has no passphrase and is kept from everyone but its owner and group; it
  /// belongs to the certificate. Whether the certificate is valid by now is not judged. Throws TlsError.
  [[nodiscard]] static TlsIdentity load(const std::string& certificate_file, const std::string& key_file);

  [[nodiscard]] ssl_ctx_st* context() const { return context_.get(); }
  /// When the certificate and its whole chain are valid, UTC.
  [[nodiscard]] TimeNs valid_from_ns() const { return valid_from_ns_; }
  [[nodiscard]] TimeNs valid_until_ns() const { return valid_until_ns_; }

 private:
  TlsIdentity() = default;
  std::shared_ptr<ssl_ctx_st> context_;
  TimeNs valid_from_ns_ = 0;
  TimeNs valid_until_ns_ = 0;
};

/// What an operator has to know of a certificate's time; `usable` is false when browsers refuse it.
struct ValidityNote {
  bool usable = true;
  std::string text;  ///< one English sentence
};
/// Nothing when all is well for longer than security::kExpiryWarning. Pure.
[[nodiscard]] std::optional<ValidityNote> validity_note(TimeNs valid_from_ns, TimeNs valid_until_ns,
                                                        TimeNs utc_ns);

}  // namespace fathom::console
