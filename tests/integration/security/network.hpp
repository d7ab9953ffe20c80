#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bus/writer.hpp"
#include "integration/bus/support.hpp"
#include "samples/nav_state.hpp"
#include "security/keygen.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

inline constexpr milliseconds kPatience{60'000};

/// Which files an attacker shows to the network.
struct Disguise {
  std::string identity_ca;
  std::string permissions_ca;
  std::string governance;
  std::string certificate;
  std::string key;
  std::string permissions;
};

/// The disguise of an honest identity of this folder.
Disguise honest(const security::CredentialFolder& files, const std::string& identity);

/// What an attacker is after. One at a time: a reader hears only the strongest writer, which would be its
/// own.
enum class Aim { reads, writes };

/// Another process that reads NavState, or writes NavState with the greatest strength and GpsSample besides,
/// as far as it gets.
class Attacker {
 public:
  /// `disguise` nothing: it does not take part in DDS Security at all. `lax`: its own side checks nothing.
  Attacker(std::uint32_t domain, Aim aim, const std::optional<Disguise>& disguise, bool lax);

  /// What it has got so far: "rounds" of 20 ms, samples "received", writers and readers "matched".
  [[nodiscard]] std::map<std::string, long> progress() const;
  /// Why its own side did not let it; empty: it did.
  [[nodiscard]] std::string error() const;

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Child> child_;
};

/// The latitude that only an attacker writes.
inline constexpr double kForged_rad = 0.666;

/// The sensor's name that good samples carry.
inline constexpr std::string_view kSampleMark = "plain_to_read";

/// A protected network with credentials of its own: fusion writes NavState 50 times a second, guidance reads
/// it.
class SecureNetwork {
 public:
  explicit SecureNetwork(std::uint32_t domain,
                         security::MessageProtection protection = security::MessageProtection::encrypt);
  ~SecureNetwork();
  SecureNetwork(const SecureNetwork&) = delete;
  SecureNetwork& operator=(const SecureNetwork&) = delete;

  [[nodiscard]] bus::ParticipantOptions options(const std::string& identity) const;
  [[nodiscard]] std::string credentials() const { return folder_ / "credentials"; }
  [[nodiscard]] security::CredentialFolder files() const { return security::CredentialFolder(credentials()); }
  [[nodiscard]] std::string scratch(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::uint32_t domain() const { return domain_; }

  /// Good samples that guidance has received, and those with an attacker's mark.
  [[nodiscard]] std::size_t good() const { return good_; }
  [[nodiscard]] std::size_t forged() const { return forged_; }
  /// Sequence numbers in the order in which guidance received them.
  [[nodiscard]] std::vector<std::uint64_t> sequences() const;
  /// The last one that fusion has written.
  [[nodiscard]] std::uint64_t written() const { return written_; }
  /// Fusion writes no more, and everything that it wrote has arrived; false when it did not.
  bool pause();
  void resume() { paused_ = false; }
  /// True when guidance receives `more` good samples from now on.
  [[nodiscard]] bool goes_on(std::size_t more = 50) const;

  std::optional<bus::Participant> fusion;
  std::optional<bus::Participant> guidance;
  std::optional<bus::Writer<NavState>> writer;
  std::optional<bus::Reader<NavState>> reader;

 private:
  TemporaryFolder folder_;
  std::uint32_t domain_;
  std::atomic<std::size_t> good_{0};
  std::atomic<std::size_t> forged_{0};
  mutable std::mutex mutex_;
  std::vector<std::uint64_t> sequences_;
  std::atomic<std::uint64_t> written_{0};
  std::atomic<bool> paused_{false};
  std::atomic<bool> idle_{false};
  std::atomic<bool> stop_{false};
  std::thread writing_;
};

}  // namespace fathom::test
