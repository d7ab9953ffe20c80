#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "http_peer.hpp"
#include "integration/services/vehicle_network.hpp"
#include "support/certificate.hpp"
#include "support/paths.hpp"
#include "support/process.hpp"

namespace fathom::test {

inline constexpr const char* kOperatorToken = "operator-0123456789";
inline constexpr const char* kViewerToken = "viewer-01234567890123";
/// What is awaited may take its time: the machine may have other things to do on every core.
inline constexpr double kPatienceS = 120.0;

/// The real fathom-console in its own process, and a vehicle around it.
class ConsoleTest : public ::testing::Test {
 protected:
  void start(std::uint32_t domain, std::vector<std::string> sets = {}) {
    port = 18420 + static_cast<int>(domain);
    token_file = std::filesystem::temp_directory_path() /
                 ("fathom-console-test-" + std::to_string(getpid()) + "-" + std::to_string(domain));
    std::ofstream(token_file) << R"({"tokens": [{"name": "bridge", "role": "operator", "token": ")"
                              << kOperatorToken << R"("}, {"name": "guest", "role": "viewer", "token": ")"
                              << kViewerToken << R"("}]})";
    chmod(token_file.c_str(), 0600);
    setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
    sets.insert(sets.begin(), {"bus.domain=" + std::to_string(domain), "http.port=" + std::to_string(port),
                               "access.token_file=" + token_file.string()});
    if (certificate != nullptr) {
      sets.push_back("tls.certificate_file=" + certificate->certificate());
      sets.push_back("tls.key_file=" + certificate->key());
    }
    std::vector<std::string> arguments{"--config", source_dir() + "/deploy/config/console.json"};
    for (const std::string& set : sets) {
      arguments.emplace_back("--set");
      arguments.push_back(set);
    }
    network = std::make_unique<VehicleNetwork>(domain, clock);
    console = std::make_unique<Process>("fathom-console", arguments);
  }
  void start_and_wait(std::uint32_t domain, const std::vector<std::string>& sets = {}) {
    start(domain, sets);
    ASSERT_TRUE(
        wait_until([&] { return get("/").status == 200 && network->nav_heard_by_someone(); }, kPatienceS))
        << console->err();
  }
  void TearDown() override {
    keep_navigating(false);
    if (console) {
      console->kill(SIGTERM);
      EXPECT_EQ(console->wait(), 0) << console->err();
    }
    std::filesystem::remove(token_file);
  }

  /// A navigation state now and then on a thread of its own, until told otherwise.
  void keep_navigating(bool on) {
    if (on == navigating) return;
    navigating = on;
    if (!on) return pump.join();
    pump = std::thread([this] {
      while (navigating) {
        network->nav();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
  }

  /// The console speaks TLS from the next start on, with this certificate.
  void use(const Certificate& own) { certificate = &own; }
  /// A connection as the console expects it.
  [[nodiscard]] std::unique_ptr<HttpPeer> peer() const {
    return certificate != nullptr
               ? std::make_unique<HttpPeer>(port, HttpPeer::Tls{certificate->certificate()})
               : std::make_unique<HttpPeer>(port);
  }
  [[nodiscard]] HttpAnswer ask(const std::string& request) const { return peer()->exchange(request); }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port); }
  [[nodiscard]] HttpAnswer get(const std::string& path, const std::string& headers = "") const {
    return ask("GET " + path + " HTTP/1.1\r\nHost: " + host() + "\r\nConnection: close\r\n" + headers +
               "\r\n");
  }
  [[nodiscard]] HttpAnswer order(const nlohmann::json& body, const std::string& token) const {
    const std::string text = body.dump();
    const std::string authorization = token.empty() ? "" : "Authorization: Bearer " + token + "\r\n";
    return ask("POST /api/order HTTP/1.1\r\nHost: " + host() +
               "\r\nOrigin: " + (certificate != nullptr ? "https://" : "http://") + host() +
               "\r\nConnection: close\r\nContent-Type: application/json\r\n" + authorization +
               "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
  }

  SystemClock clock;
  int port = 0;
  std::filesystem::path token_file;
  const Certificate* certificate = nullptr;
  std::unique_ptr<VehicleNetwork> network;
  std::unique_ptr<Process> console;
  std::atomic<bool> navigating{false};
  std::thread pump;
};

}  // namespace fathom::test
