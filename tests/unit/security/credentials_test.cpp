// Credentials: made, renewed, checked, and every way in which they can be wrong, each in one sentence.

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "security/inspect.hpp"
#include "security/keygen.hpp"
#include "security/roles.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using security::check_credentials;
using security::CredentialFolder;
using security::SecurityError;
using testing::HasSubstr;

constexpr TimeNs kNow = 1'800'000'000 * kNsPerSecond;  // 2027-01-15
constexpr DurationNs kDay = 86400 * kNsPerSecond;

class Credentials : public testing::Test {
 protected:
  Credentials() : files(folder / "credentials") {
    options.folder = files.path().string();
    options.domains = {10, 20};
    security::make_credentials(options, kNow);
  }

  /// What is said of identity `name` at `now`; empty: nothing is wrong.
  std::string fault(const std::string& name = "fusion", std::uint32_t domain = 15, TimeNs now = kNow) {
    try {
      (void)check_credentials(options.folder, name, domain, now);
      return {};
    } catch (const SecurityError& error) {
      return error.what();
    }
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static unsigned mode(const fs::path& file) {
    struct stat facts {};
    EXPECT_EQ(stat(file.c_str(), &facts), 0) << file;
    return facts.st_mode & 0777U;
  }

  TemporaryFolder folder;
  CredentialFolder files;
  security::KeygenOptions options;
};

TEST_F(Credentials, OfEveryRoleHold) {
  for (const security::Role& role : security::roles()) EXPECT_EQ(fault(std::string(role.name)), "");
  const auto found = security::inspect(options.folder, kNow);
  EXPECT_TRUE(found.good());
  EXPECT_EQ(found.items.size(), security::roles().size() + 2);
  EXPECT_EQ(found.vehicle, "auv");
  EXPECT_TRUE(found.authority_present);
}

TEST_F(Credentials, KeysAreTheirOwnersOnly) {
  int keys = 0;
  for (const auto& entry : fs::recursive_directory_iterator(options.folder)) {
    if (entry.path().filename().string().find("key.pem") == std::string::npos) continue;
    EXPECT_EQ(mode(entry.path()), 0600U) << entry.path();
    ++keys;
  }
  EXPECT_EQ(keys, static_cast<int>(security::roles().size()) + 2);
  EXPECT_EQ(mode(files.authority()), 0700U);
  EXPECT_EQ(mode(files.governance()), 0644U);
}

TEST_F(Credentials, AnExistingAuthorityIsKeptUnlessForced) {
  const std::string before = security::read_text(files.identity_ca());
  EXPECT_THROW(security::make_credentials(options, kNow), SecurityError);
  EXPECT_EQ(security::read_text(files.identity_ca()), before);
  options.replace = true;
  security::make_credentials(options, kNow);
  EXPECT_NE(security::read_text(files.identity_ca()), before);
  EXPECT_TRUE(security::inspect(options.folder, kNow).good());
}

TEST_F(Credentials, OneIsRenewedAndTheOthersStay) {
  const auto key = [&](const std::string& name) { return security::read_text(files.key(name)); };
  const std::string authority = security::read_text(files.identity_ca());
  const std::string fusion = key("fusion");
  const std::string monitor = key("monitor");
  security::renew_identities(options.folder, {"fusion"}, 100, kNow + 50 * kDay);
  EXPECT_NE(key("fusion"), fusion);
  EXPECT_EQ(key("monitor"), monitor);
  EXPECT_EQ(fault("fusion", 15, kNow + 149 * kDay), "");
  EXPECT_THAT(fault("fusion", 15, kNow + 151 * kDay), HasSubstr("expired on"));
  EXPECT_EQ(mode(files.key("fusion")), 0600U);
  EXPECT_FALSE(fs::exists(files.identity("fusion").string() + ".new"));

  security::renew_identities(options.folder, {}, 365, kNow + 50 * kDay);
  EXPECT_NE(key("monitor"), monitor);
  EXPECT_EQ(security::read_text(files.identity_ca()), authority);
  EXPECT_TRUE(security::inspect(options.folder, kNow + 50 * kDay).good());
}

TEST_F(Credentials, RenewalNeedsTheAuthoritysKeysAndEnoughOfItsTime) {
  EXPECT_THROW(security::renew_identities(options.folder, {"nobody"}, 10, kNow), SecurityError);
  EXPECT_THROW(security::renew_identities(options.folder, {}, options.ca_days + 1, kNow), SecurityError);
  fs::remove_all(files.authority());  // as on the vehicle
  EXPECT_THROW(security::renew_identities(options.folder, {}, 10, kNow), SecurityError);
  EXPECT_EQ(fault(), "");
}

TEST_F(Credentials, WhatIsMissingIsNamed) {
  EXPECT_THAT(fault("nobody"), HasSubstr("has no identity 'nobody'"));
  EXPECT_THAT(fault("../credentials/fusion"), HasSubstr("has no identity"));
  for (const fs::path& file :
       {files.identity_ca(), files.permissions_ca(), files.governance(), files.key("fusion"),
        files.certificate("fusion"), files.permissions("fusion")}) {
    const fs::path aside = file.string() + ".aside";
    fs::rename(file, aside);
    EXPECT_THAT(fault(), HasSubstr(file.string() + ": cannot be read"));
    fs::rename(aside, file);
  }
  EXPECT_EQ(fault(), "");
  fs::remove_all(options.folder);
  EXPECT_THAT(fault(), HasSubstr("is no folder"));
}

TEST_F(Credentials, AKeyThatOthersMayReadIsRefused) {
  chmod(files.key("fusion").c_str(), 0640);
  EXPECT_THAT(fault(), HasSubstr("key.pem: is open to others than its owner (mode 0640)"));
}

TEST_F(Credentials, GarbageIsNamed) {
  write(files.key("fusion"), "not a key");
  EXPECT_THAT(fault(), HasSubstr("key.pem: holds no private key"));
  write(files.certificate("monitor"), "not a certificate");
  EXPECT_THAT(fault("monitor"), HasSubstr("certificate.pem: holds no certificate"));
  write(files.governance(), "not signed");
  EXPECT_THAT(fault("cli"), HasSubstr("governance.smime: is no signed document"));
}

TEST_F(Credentials, TheKeyOfAnotherIsRefused) {
  fs::copy_file(files.key("monitor"), files.key("fusion"), fs::copy_options::overwrite_existing);
  EXPECT_THAT(fault(), HasSubstr("key.pem: belongs to another certificate"));
}

TEST_F(Credentials, AnotherAuthoritysIdentityIsRefused) {
  security::KeygenOptions foreign = options;
  foreign.folder = folder / "foreign";
  security::make_credentials(foreign, kNow);
  fs::remove_all(files.identity("fusion"));
  fs::copy(CredentialFolder(foreign.folder).identity("fusion"), files.identity("fusion"));
  EXPECT_THAT(fault(), HasSubstr("certificate.pem: is not vouched for by"));
}

TEST_F(Credentials, AChangedOrForeignPermissionIsRefused) {
  std::string document = security::read_text(files.permissions("imu_bridge"));
  document.replace(document.find("fathom/v1/imu<"), 13, "fathom/v1/gps");
  write(files.permissions("imu_bridge"), document);
  EXPECT_THAT(fault("imu_bridge"), HasSubstr("permissions.smime: the signature does not hold"));
  fs::copy_file(files.permissions("fusion"), files.permissions("gps_bridge"),
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(fault("gps_bridge"),
              HasSubstr("permissions.smime: is for 'CN=fusion,OU=auv,O=fathom', expected"));
}

TEST_F(Credentials, OtherDomainsAreRefused) {
  EXPECT_EQ(fault("fusion", 10), "");
  EXPECT_EQ(fault("fusion", 20), "");
  EXPECT_THAT(fault("fusion", 9), HasSubstr("is for domains 10 to 20, expected domain 9 among them"));
  EXPECT_THAT(fault("fusion", 21), HasSubstr("is for domains 10 to 20, expected domain 21 among them"));
}

TEST_F(Credentials, DatesAreKept) {
  EXPECT_EQ(fault("fusion", 15, kNow + 365 * kDay - kNsPerSecond), "");
  EXPECT_THAT(fault("fusion", 15, kNow + 365 * kDay + kNsPerSecond),
              HasSubstr("the identity expired on 2028-01-15"));
  EXPECT_EQ(fault("fusion", 15, kNow - kDay), "");
  EXPECT_THAT(fault("fusion", 15, kNow - kDay - kNsPerSecond), HasSubstr("expected a clock that is set"));
  EXPECT_EQ(security::expiry_text(kNow, kNow - 31 * kDay), "");
  EXPECT_EQ(security::expiry_text(kNow, kNow - 30 * kDay), "expires in 30 days (2027-01-15)");
  EXPECT_EQ(security::expiry_text(kNow, kNow + 1), "has expired on 2027-01-15");
}

TEST_F(Credentials, AnInspectionSpeaksOfTheEndInTime) {
  EXPECT_TRUE(security::inspect(options.folder, kNow + 334 * kDay).good());
  const auto near = security::inspect(options.folder, kNow + 336 * kDay);
  EXPECT_FALSE(near.good());
  for (const auto& item : near.items) {
    if (item.name.ends_with("_ca")) continue;
    EXPECT_TRUE(item.usable);
    EXPECT_THAT(item.fault, HasSubstr("expires in 29 days"));
  }
  const auto past = security::inspect(options.folder, kNow + 366 * kDay);
  EXPECT_FALSE(past.items.back().usable);
}

TEST_F(Credentials, AnInspectionFindsWhatIsMissingAndWhatIsOutOfDate) {
  fs::remove_all(files.identity("monitor"));
  const auto by_name = [&] {
    std::map<std::string, security::Inspected> out;
    for (const auto& item : security::inspect(options.folder, kNow).items) out[item.name] = item;
    return out;
  };
  EXPECT_THAT(by_name()["monitor"].fault, HasSubstr("no such identity"));

  // Permissions signed by the right authority, but of another build.
  const std::string xml = security::permissions_xml({"fusion",
                                                     "CN=fusion,OU=auv,O=fathom",
                                                     {kNow - kDay, kNow + 366 * kDay},
                                                     options.domains,
                                                     {"fathom/v0/nav_state"},
                                                     {}});
  const auto key = security::key_from_pem(security::read_text(files.permissions_ca_key()), "");
  const auto ca = security::certificate_from_pem(security::read_text(files.permissions_ca()), "");
  write(files.permissions("fusion"), security::sign_document(xml, key, ca));
  EXPECT_THAT(by_name()["fusion"].fault, HasSubstr("differ from this build's"));
  EXPECT_EQ(by_name()["gps_bridge"].fault, "");
}

TEST(Documents, SayWhatTheyWereMadeOf) {
  const security::Grant grant{"gps <&\" bridge",
                              "CN=gps_bridge,OU=auv,O=fathom",
                              {kNow, kNow + kDay},
                              {3, 7},
                              {"fathom/v1/gps", "fathom/v1/service_status"},
                              {"fathom/v1/*"}};
  const auto read = security::grant_from_xml(security::permissions_xml(grant), "here");
  EXPECT_EQ(read.name, grant.name);
  EXPECT_EQ(read.subject, grant.subject);
  EXPECT_EQ(read.validity.from_ns, grant.validity.from_ns);
  EXPECT_EQ(read.validity.until_ns, grant.validity.until_ns);
  EXPECT_EQ(read.domains.first, 3U);
  EXPECT_EQ(read.domains.last, 7U);
  EXPECT_EQ(read.publishes, grant.publishes);
  EXPECT_EQ(read.subscribes, grant.subscribes);
  for (const auto kind : {security::MessageProtection::sign, security::MessageProtection::encrypt}) {
    const auto governance = security::governance_from_xml(security::governance_xml({1, 2}, kind), "here");
    EXPECT_EQ(governance.domains.last, 2U);
    EXPECT_EQ(governance.protection, kind);
  }
  EXPECT_THROW((void)security::grant_from_xml("<dds><permissions/></dds>", "here"), SecurityError);
  EXPECT_THROW((void)security::grant_from_xml("no xml", "here"), SecurityError);
  EXPECT_THROW((void)security::governance_from_xml("<dds/>", "here"), SecurityError);
}

TEST(Names, OfVehiclesAndIdentitiesArePlain) {
  for (const char* good : {"auv", "fusion-2", "a.b_c", "X"})
    EXPECT_TRUE(security::is_plain_name(good)) << good;
  for (const std::string bad : {"", ".", "..", "a/b", "a b", "a,CN=b", "\xc3\xa4"}) {
    EXPECT_FALSE(security::is_plain_name(bad)) << bad;
  }
  EXPECT_FALSE(security::is_plain_name(std::string(65, 'a')));
}

}  // namespace
}  // namespace fathom::test
