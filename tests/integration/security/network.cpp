#include "network.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <utility>

#include "base/clock.hpp"
#include "samples/gps.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string whole(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The QoS profiles with the attacker's files in that of the participant: our own options would check them.
void write_profiles(const fs::path& folder, const std::optional<Disguise>& disguise) {
  fs::create_directory(folder);
  for (const auto& entry : fs::directory_iterator(source_dir() + "/deploy/dds")) {
    std::string text = whole(entry.path());
    const std::string end = "    </rtps>\n  </participant>";
    const std::size_t at = text.find(end);
    if (disguise && at != std::string::npos) {
      std::string properties = "<propertiesPolicy><properties>";
      const auto set = [&](const std::string& name, const std::string& value) {
        properties += "<property><name>dds.sec." + name + "</name><value>" + value + "</value></property>";
      };
      const std::string auth = "auth.builtin.PKI-DH.";
      const std::string access = "access.builtin.Access-Permissions.";
      set("auth.plugin", "builtin.PKI-DH");
      set(auth + "identity_ca", "file://" + disguise->identity_ca);
      set(auth + "identity_certificate", "file://" + disguise->certificate);
      set(auth + "private_key", "file://" + disguise->key);
      set("access.plugin", "builtin.Access-Permissions");
      set(access + "permissions_ca", "file://" + disguise->permissions_ca);
      set(access + "governance", "file://" + disguise->governance);
      set(access + "permissions", "file://" + disguise->permissions);
      set("crypto.plugin", "builtin.AES-GCM-GMAC");
      text.insert(at, properties + "</properties></propertiesPolicy>\n");
    }
    std::ofstream(folder / entry.path().filename()) << text;
  }
}

/// Body of the attacker's process.
TEST(ChildProcess, DISABLED_Attacks) {
  const fs::path folder = variable("TEST_FOLDER");
  const auto say = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / (name + ".new")) << text;
    fs::rename(folder / (name + ".new"), folder / name);
  };
  try {
    bus::ParticipantOptions presence =
        options(static_cast<std::uint32_t>(std::stoul(variable("TEST_DOMAIN"))), "attacker");
    presence.profiles_dir = folder / "dds";
    bus::Participant participant(presence);
    std::atomic<long> received = 0;
    std::optional<bus::Reader<NavState>> reader;
    std::optional<bus::Writer<NavState>> nav;
    std::optional<bus::Writer<GpsSample>> gps;
    if (variable("TEST_AIM") == "reads") {
      reader.emplace(participant, [&](const NavState&, const bus::SampleInfo&) { ++received; });
    } else {
      nav.emplace(participant, bus::WriterOptions{{}, 1'000'000});
      gps.emplace(participant);
    }
    NavState state;
    state.header.vehicle = "auv";
    state.latitude_rad = kForged_rad;
    GpsSample fix;
    fix.header.vehicle = "auv";
    fix.header.sensor = "gps";
    fix.latitude_rad = kForged_rad;
    long rounds = 0;
    until_stopped(milliseconds(20), [&] {
      state.header.sequence = fix.header.sequence = static_cast<std::uint64_t>(++rounds);
      if (nav) nav->write(state);
      if (gps) gps->write(fix);
      const int matched =
          reader ? reader->matched_writers() : nav->matched_readers() + gps->matched_readers();
      say("progress", "rounds " + std::to_string(rounds) + " received " + std::to_string(received) +
                          " matched " + std::to_string(matched));
    });
  } catch (const bus::BusError& error) {
    say("error", error.what());
  }
}

}  // namespace

Disguise honest(const security::CredentialFolder& files, const std::string& identity) {
  return {files.identity_ca(),         files.permissions_ca(), files.governance(),
          files.certificate(identity), files.key(identity),    files.permissions(identity)};
}

Attacker::Attacker(std::uint32_t domain, Aim aim, const std::optional<Disguise>& disguise, bool lax) {
  write_profiles(folder_.path() / "dds", disguise);
  std::vector<std::string> variables{"TEST_FOLDER=" + folder_.path().string(),
                                     "TEST_DOMAIN=" + std::to_string(domain),
                                     aim == Aim::reads ? "TEST_AIM=reads" : "TEST_AIM=writes"};
  if (lax) variables.emplace_back("TEST_LAX=1");
  child_ = std::make_unique<Child>("ChildProcess.DISABLED_Attacks", variables);
}

std::map<std::string, long> Attacker::progress() const {
  std::stringstream text(whole(folder_.path() / "progress"));
  std::map<std::string, long> out;
  std::string name;
  long value = 0;
  while (text >> name >> value) out[name] = value;
  return out;
}

std::string Attacker::error() const {
  return whole(folder_.path() / "error");
}

SecureNetwork::SecureNetwork(std::uint32_t domain, security::MessageProtection protection) : domain_(domain) {
  security::KeygenOptions keygen;
  keygen.folder = credentials();
  keygen.domains = {domain, domain};
  keygen.protection = protection;
  security::make_credentials(keygen, SystemClock().utc_ns());
  fusion.emplace(options("fusion"));
  guidance.emplace(options("guidance"));
  writer.emplace(*fusion, bus::WriterOptions{{}, 1});
  reader.emplace(*guidance, [this](const NavState& state, const bus::SampleInfo&) {
    ++(state.latitude_rad == kForged_rad ? forged_ : good_);
    const std::lock_guard lock(mutex_);
    sequences_.push_back(state.header.sequence);
  });
  writing_ = std::thread([this] {
    NavState state;
    state.header.vehicle = "auv";
    state.header.sensor = kSampleMark;
    while (!stop_) {
      idle_ = paused_.load();
      if (!idle_) {
        state.header.sequence = ++written_;
        writer->write(state);
      }
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
}

SecureNetwork::~SecureNetwork() {
  stop_ = true;
  writing_.join();
  reader.reset();  // what it tells goes before it
}

std::vector<std::uint64_t> SecureNetwork::sequences() const {
  const std::lock_guard lock(mutex_);
  return sequences_;
}

bool SecureNetwork::pause() {
  paused_ = true;
  return eventually([&] { return idle_.load(); }, kPatience) &&
         eventually([&] { return !sequences().empty() && sequences().back() == written(); }, kPatience);
}

bus::ParticipantOptions SecureNetwork::options(const std::string& identity) const {
  bus::ParticipantOptions out = test::options(domain_, identity);
  out.security = {credentials(), ""};
  return out;
}

bool SecureNetwork::goes_on(std::size_t more) const {
  const std::size_t before = good();
  return eventually([&] { return good() >= before + more; }, kPatience);
}

}  // namespace fathom::test
