// Whoever has not proved an identity of this vehicle, or has no permission, reads nothing, is heard by
// nobody, and is counted; those who belong together go on.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "base/clock.hpp"
#include "bus/detail/versions/discovery_listener.hpp"
#include "network.hpp"
#include "samples/gps.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using bus::BusEventKind;
using testing::HasSubstr;

constexpr DurationNs kDay = 86400 * kNsPerSecond;

void expect_stranger_counted(SecureNetwork& network) {
  EXPECT_TRUE(eventually([&] { return network.fusion->counters().stranger_refused > 0; }, kPatience));
  EXPECT_TRUE(eventually([&] { return network.guidance->counters().stranger_refused > 0; }, kPatience));
}

/// The attacker has been at it for longer than good ones need to meet, and has got nothing.
void expect_nothing(SecureNetwork& network, const Attacker& attacker) {
  ASSERT_TRUE(eventually([&] { return attacker.progress()["rounds"] > 200; }, kPatience)) << attacker.error();
  EXPECT_TRUE(network.goes_on());
  EXPECT_EQ(attacker.progress()["received"], 0);
  EXPECT_EQ(attacker.progress()["matched"], 0);
  EXPECT_EQ(network.forged(), 0U);
}

/// Both aims; for those whom nobody speaks to.
void expect_a_stranger(SecureNetwork& network, const std::optional<Disguise>& disguise, bool lax) {
  {
    const Attacker reads(network.domain(), Aim::reads, disguise, lax);
    expect_stranger_counted(network);
    expect_nothing(network, reads);
  }
  const Attacker writes(network.domain(), Aim::writes, disguise, lax);
  expect_nothing(network, writes);
}

TEST(Strangers, GoodOnesMeetAndAreCalledByName) {
  SecureNetwork network(50);
  ASSERT_TRUE(network.goes_on());
  ASSERT_EQ(network.guidance->peers().size(), 1U);
  EXPECT_EQ(network.guidance->peers()[0].name, "fusion");
  EXPECT_TRUE(network.guidance->strangers().empty());
  EXPECT_EQ(network.guidance->counters().stranger_refused, 0U);
  EXPECT_EQ(network.guidance->credentials_warning(SystemClock().utc_ns()), "");
  EXPECT_THAT(network.guidance->credentials_warning(SystemClock().utc_ns() + 340 * kDay),
              HasSubstr("identity guidance expires in "));
}

TEST(Strangers, SignedMessagesPassAsWell) {
  SecureNetwork network(50, security::MessageProtection::sign);
  EXPECT_TRUE(network.goes_on());
}

// What the other tests' attacker can do where nothing keeps it from it.
TEST(Strangers, WhoHasTheRightCredentialsIsHeardAndHears) {
  SecureNetwork network(50);
  ASSERT_TRUE(network.goes_on());
  {
    const Attacker writes(50, Aim::writes, honest(network.files(), "fusion"), true);
    EXPECT_TRUE(eventually([&] { return network.forged() > 50; }, kPatience)) << writes.error();
  }
  const Attacker reads(50, Aim::reads, honest(network.files(), "monitor"), false);
  EXPECT_TRUE(eventually([&] { return reads.progress()["received"] > 50; }, kPatience)) << reads.error();
}

TEST(Strangers, OneWithoutSecurityGetsNothing) {
  SecureNetwork network(51);
  const Events events(*network.guidance);
  ASSERT_TRUE(network.goes_on());
  expect_a_stranger(network, std::nullopt, false);
  const Attacker attacker(51, Aim::reads, std::nullopt, false);
  ASSERT_TRUE(eventually([&] { return !network.guidance->strangers().empty(); }, kPatience));
  const std::string name = network.guidance->strangers()[0].name;
  EXPECT_EQ(name, bus::detail::kAnnouncesStrangers ? "attacker" : "");
  EXPECT_EQ(network.guidance->peers().size(), 1U);
  ASSERT_FALSE(events.of(BusEventKind::stranger_refused).empty());
  const std::string detail = events.of(BusEventKind::stranger_refused)[0].detail;
  if (bus::detail::kAnnouncesStrangers) {
    EXPECT_THAT(detail, testing::AllOf(HasSubstr("'attacker' (GUID "), HasSubstr("127.0.0.1"),
                                       HasSubstr("offers no identity")));
  } else {
    EXPECT_THAT(detail, testing::AllOf(HasSubstr("one without a name (GUID "),
                                       HasSubstr("could not prove an identity")));
  }
}

TEST(Strangers, OneOfAForeignAuthorityGetsNothing) {
  SecureNetwork network(52);
  ASSERT_TRUE(network.goes_on());
  security::KeygenOptions foreign;
  foreign.folder = network.scratch("foreign");
  foreign.domains = {52, 52};
  security::make_credentials(foreign, SystemClock().utc_ns());
  expect_a_stranger(network, honest(security::CredentialFolder(foreign.folder), "fusion"), true);
}

TEST(Strangers, OneWhoseCertificateExpiredGetsNothing) {
  SecureNetwork network(53);
  ASSERT_TRUE(network.goes_on());
  const security::CredentialFolder files = network.files();
  const TimeNs now = SystemClock().utc_ns();
  // Issued by the right authority, over since yesterday; its permissions go on.
  const auto pem = [](const fs::path& file) { return security::read_text(file); };
  const auto key = security::generate_key();
  const auto certificate = security::issue(key, {"auv", "fusion"}, {now - 400 * kDay, now - kDay},
                                           security::key_from_pem(pem(files.identity_ca_key()), ""),
                                           security::certificate_from_pem(pem(files.identity_ca()), ""));
  Disguise disguise = honest(files, "fusion");
  disguise.key = network.scratch("expired_key.pem");
  disguise.certificate = network.scratch("expired.pem");
  security::write_private(disguise.key, security::to_pem(key));
  security::write_text(disguise.certificate, security::to_pem(certificate));
  expect_a_stranger(network, disguise, true);
}

TEST(Strangers, OneThatSignedItsOwnPermissionsGetsNothing) {
  SecureNetwork network(54);
  ASSERT_TRUE(network.goes_on());
  const TimeNs now = SystemClock().utc_ns();
  // A valid identity with permissions to do everything, of an authority that bears the right name.
  const auto key = security::generate_key();
  const auto authority = security::make_authority(key, {"auv", "permissions_ca"}, {now - kDay, now + kDay});
  const auto sign = [&](const std::string& name, const std::string& text) {
    security::write_text(network.scratch(name), security::sign_document(text, key, authority));
    return network.scratch(name);
  };
  Disguise disguise = honest(network.files(), "gps_bridge");
  disguise.permissions_ca = network.scratch("permissions_ca.pem");
  security::write_text(disguise.permissions_ca, security::to_pem(authority));
  disguise.governance =
      sign("governance", security::governance_xml({54, 54}, security::MessageProtection::encrypt));
  disguise.permissions = sign("permissions", security::permissions_xml({"gps_bridge",
                                                                        "CN=gps_bridge,OU=auv,O=fathom",
                                                                        {now - 2 * kDay, now + 2 * kDay},
                                                                        {54, 54},
                                                                        {"*"},
                                                                        {"*"}}));
  expect_a_stranger(network, disguise, true);
}

TEST(Strangers, AnIdentityWithoutPermissionIsNotHeardEvenWhenItsOwnSideLetsIt) {
  SecureNetwork network(55);
  const Events at_guidance(*network.guidance);
  ASSERT_TRUE(network.goes_on());
  for (const Aim aim : {Aim::reads, Aim::writes}) {
    const Attacker attacker(55, aim, honest(network.files(), "gps_bridge"), true);
    // It may publish fixes, which nobody here reads.
    expect_nothing(network, attacker);
  }
  EXPECT_TRUE(eventually([&] { return network.guidance->counters().permission_refused > 0; }, kPatience));
  EXPECT_TRUE(eventually([&] { return network.fusion->counters().permission_refused > 0; }, kPatience));
  ASSERT_FALSE(at_guidance.of(BusEventKind::permission_refused).empty());
  EXPECT_EQ(at_guidance.of(BusEventKind::permission_refused)[0].topic, "fathom/v1/nav_state");
  EXPECT_EQ(network.guidance->counters().stranger_refused, 0U);  // it is one of us, and named
}

TEST(Strangers, AConsoleMayNotPublishASensor) {
  SecureNetwork network(56);
  std::atomic<std::size_t> fixes = 0;
  std::atomic<std::size_t> forged = 0;
  bus::Reader<GpsSample> reader(*network.fusion, [&](const GpsSample& fix, const bus::SampleInfo&) {
    ++(fix.latitude_rad == kForged_rad ? forged : fixes);
  });
  bus::Participant bridge(network.options("gps_bridge"));
  bus::Writer<GpsSample> gps(bridge);
  ASSERT_TRUE(eventually([&] { return gps.matched_readers() == 1; }, kPatience));

  // Its own side refuses already ...
  bus::Participant console(network.options("console"));
  try {
    const bus::Writer<GpsSample> not_allowed(console);
    ADD_FAILURE() << "a console could make a writer of fixes";
  } catch (const bus::BusError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the permissions of identity 'console'"));
    EXPECT_THAT(error.what(), HasSubstr("do not allow fathom/v1/gps"));
  }
  // ... and where it does not, nobody listens.
  const Attacker attacker(56, Aim::writes, honest(network.files(), "console"), true);
  ASSERT_TRUE(eventually([&] { return attacker.progress()["rounds"] > 200; }, kPatience)) << attacker.error();
  EXPECT_EQ(forged, 0U);
  EXPECT_EQ(network.forged(), 0U);
  EXPECT_TRUE(eventually([&] { return network.fusion->counters().permission_refused > 0; }, kPatience));
  GpsSample fix;
  fix.header.vehicle = "auv";
  fix.header.sensor = "gps";
  ASSERT_TRUE(gps.write(fix));
  EXPECT_TRUE(eventually([&] { return fixes == 1; }, kPatience));
  EXPECT_TRUE(network.goes_on());
}

TEST(Strangers, CredentialsAreCheckedBeforeAnythingIsSent) {
  const SecureNetwork network(57);
  bus::ParticipantOptions missing = network.options("nobody");
  EXPECT_THROW(bus::Participant{missing}, bus::CredentialsError);
  missing.security.identity = "cli";  // another name than the identity's is fine
  EXPECT_NO_THROW(bus::Participant{missing});
  missing.domain = 58;  // Fast DDS would join it and protect nothing
  EXPECT_THROW(bus::Participant{missing}, bus::CredentialsError);
}

}  // namespace
}  // namespace fathom::test
