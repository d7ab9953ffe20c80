#pragma once

#include <filesystem>
#include <string>

#include "security/error.hpp"

namespace fathom::security {

/// Where the credentials of a vehicle lie:
///
///   identity_ca.pem permissions_ca.pem governance.smime    everybody's
///   NAME/certificate.pem NAME/key.pem NAME/permissions.smime    of the identity NAME
///   authority/identity_ca_key.pem authority/permissions_ca_key.pem    not for the vehicle
///
/// The *.xml beside each *.smime is what was signed, for people to read.
class CredentialFolder {
 public:
  explicit CredentialFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] std::filesystem::path identity_ca() const { return folder_ / "identity_ca.pem"; }
  [[nodiscard]] std::filesystem::path permissions_ca() const { return folder_ / "permissions_ca.pem"; }
  [[nodiscard]] std::filesystem::path governance() const { return folder_ / "governance.smime"; }
  [[nodiscard]] std::filesystem::path authority() const { return folder_ / "authority"; }
  [[nodiscard]] std::filesystem::path identity_ca_key() const { return authority() / "identity_ca_key.pem"; }
  [[nodiscard]] std::filesystem::path permissions_ca_key() const {
    return authority() / "permissions_ca_key.pem";
  }
  [[nodiscard]] std::filesystem::path identity(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::filesystem::path certificate(const std::string& name) const {
    return identity(name) / "certificate.pem";
  }
  [[nodiscard]] std::filesystem::path key(const std::string& name) const {
    return identity(name) / "key.pem";
  }
  [[nodiscard]] std::filesystem::path permissions(const std::string& name) const {
    return identity(name) / "permissions.smime";
  }

 private:
  std::filesystem::path folder_;
};

/// The whole text of a small file. Throws SecurityError naming it and what is wrong with it.
[[nodiscard]] std::string read_text(const std::filesystem::path& file);
/// As read_text(), for a private key: nobody but its owner may have access to the file.
[[nodiscard]] std::string read_private(const std::filesystem::path& file);
/// Writes beside the file and then in its place; on the disk when it returns. Throws SecurityError.
void write_text(const std::filesystem::path& file, const std::string& text);
/// The same, readable by its owner only.
void write_private(const std::filesystem::path& file, const std::string& text);

}  // namespace fathom::security
