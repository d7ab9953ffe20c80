#include "console/http/tls.hpp"

#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/clock.hpp"
#include "support/certificate.hpp"

namespace fathom::console {
namespace {

constexpr DurationNs kDay = 24LL * 3600 * kNsPerSecond;

/// The message and the file of the TlsError that comes of the two files.
std::string fault(const std::string& certificate, const std::string& key, TlsError::File& file) {
  try {
    (void)TlsIdentity::load(certificate, key);
  } catch (const TlsError& error) {
    file = error.file();
    return error.what();
  }
  ADD_FAILURE() << "no TlsError";
  return {};
}

TEST(TlsIdentity, KnowsHowLongItIsValid) {
  const test::Certificate own(-10, 20);
  const TlsIdentity identity = TlsIdentity::load(own.certificate(), own.key());
  const TimeNs now = SystemClock().utc_ns();
  EXPECT_NE(identity.context(), nullptr);
  EXPECT_NEAR(to_seconds(now - identity.valid_from_ns()), to_seconds(10 * kDay), 600);
  EXPECT_NEAR(to_seconds(identity.valid_until_ns() - now), to_seconds(20 * kDay), 600);
}

TEST(TlsIdentity, IsValidAsLongAsItsWholeChain) {
  const test::Certificate own(-10, 200);
  const test::Certificate above(-5, 20);
  std::ofstream(own.certificate(), std::ios::app) << std::ifstream(above.certificate()).rdbuf();
  const TlsIdentity identity = TlsIdentity::load(own.certificate(), own.key());
  const TimeNs now = SystemClock().utc_ns();
  EXPECT_NEAR(to_seconds(now - identity.valid_from_ns()), to_seconds(5 * kDay), 600);
  EXPECT_NEAR(to_seconds(identity.valid_until_ns() - now), to_seconds(20 * kDay), 600);
}

TEST(TlsIdentity, SaysWhichFileIsWrongAndHow) {
  const test::Certificate own;
  const test::Certificate other;
  const test::Certificate secret(-1, 10, "passphrase");
  const std::string garbage = (own.folder() / "garbage.pem").string();
  std::ofstream(garbage) << "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n";
  const std::string open_key = (own.folder() / "open.pem").string();
  std::ofstream(open_key) << std::ifstream(own.key()).rdbuf();
  chmod(open_key.c_str(), 0644);
  chmod(garbage.c_str(), 0600);
  using File = TlsError::File;
  struct Case {
    std::string certificate;
    std::string key;
    File file;
    std::string path;  ///< the one that is named
    const char* says;
  };
  const std::string nowhere = "/nonexistent/pem";
  const std::vector<Case> cases{
      {nowhere, own.key(), File::certificate, nowhere, "No such file"},
      {own.certificate(), nowhere, File::key, nowhere, "No such file"},
      {own.folder().string(), own.key(), File::certificate, own.folder().string(), "is no file"},
      {garbage, own.key(), File::certificate, garbage, "expected a certificate in PEM"},
      {own.certificate(), garbage, File::key, garbage, "expected a private key in PEM"},
      {own.certificate(), other.key(), File::key, other.key(), "is not the key of"},
      {own.certificate(), open_key, File::key, open_key, "expected mode 0600"},
      {secret.certificate(), secret.key(), File::key, secret.key(), "has a passphrase"},
  };
  for (const Case& item : cases) {
    File file = item.file == File::key ? File::certificate : File::key;
    const std::string message = fault(item.certificate, item.key, file);
    EXPECT_NE(message.find(item.says), std::string::npos) << message;
    EXPECT_EQ(message.find(item.path), 0U) << message;
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
    EXPECT_EQ(file, item.file) << message;
  }
}

TEST(Validity, IsSilentUntilThirtyDaysBeforeTheEnd) {
  const TimeNs from = 1'700'000'000 * kNsPerSecond;
  const TimeNs until = from + 365 * kDay;
  EXPECT_FALSE(validity_note(from, until, from).has_value());
  EXPECT_FALSE(validity_note(from, until, until - 31 * kDay).has_value());
  const auto soon = validity_note(from, until, until - 29 * kDay - kDay / 2);
  ASSERT_TRUE(soon.has_value());
  EXPECT_TRUE(soon->usable);
  EXPECT_NE(soon->text.find("expires in 29 days"), std::string::npos) << soon->text;
  const auto over = validity_note(from, until, until);
  ASSERT_TRUE(over.has_value());
  EXPECT_FALSE(over->usable);
  EXPECT_NE(over->text.find("expired at 2024-11-13"), std::string::npos) << over->text;
  const auto early = validity_note(from, until, from - 1);
  ASSERT_TRUE(early.has_value());
  EXPECT_FALSE(early->usable);
  EXPECT_NE(early->text.find("not valid before 2023-11-14"), std::string::npos) << early->text;
}

}  // namespace
}  // namespace fathom::console
