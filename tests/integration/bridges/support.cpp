#include "support.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <pty.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "support/paths.hpp"
#include "support/presence.hpp"

extern char** environ;

namespace fathom::test {
namespace {

using Seconds = std::chrono::duration<double>;

void check(bool good, const char* what) {
  if (!good) throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

int bound_port(int socket) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  check(getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  return ntohs(address.sin_port);
}

}  // namespace

TimeNs utc_now() {
  using std::chrono::duration_cast;
  return duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

bool eventually(const std::function<bool()>& condition, double limit_s) {
  const auto end = std::chrono::steady_clock::now() + Seconds(limit_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "fathom_test_XXXXXX").string();
  check(mkdtemp(pattern.data()) != nullptr, "mkdtemp");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Process::Process(const std::string& executable, const std::vector<std::string>& arguments,
                 const std::string& log)
    : log_(log) {
  const std::string path = binary_dir() + "/bin/" + executable;
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  const int error = posix_spawn(&pid_, path.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error(path + ": " + std::strerror(error));
}

Process::~Process() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Process::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

int Process::wait(double limit_s) {
  int status = 0;
  const bool ended = eventually([&] { return waitpid(pid_, &status, WNOHANG) == pid_; }, limit_s);
  if (!ended) return -1;
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string Process::output() const {
  std::ostringstream out;
  out << std::ifstream(log_).rdbuf();
  return out.str();
}

std::vector<std::string> bridge_arguments(const std::string& kind, int domain,
                                          const std::vector<std::string>& sets) {
  const std::string source = source_dir();
  std::vector<std::string> out{"--config", source + "/deploy/config/" + kind + "_bridge.json",
                               "--set",    "bus.domain=" + std::to_string(domain),
                               "--set",    "bus.profiles_dir=" + source + "/deploy/dds"};
  for (const auto& set : sets) {
    out.emplace_back("--set");
    out.push_back(set);
  }
  return out;
}

SerialDevice::SerialDevice(std::string path) : path_(std::move(path)) {
  int slave = -1;
  std::array<char, 128> name{};
  check(openpty(&master_, &slave, name.data(), nullptr, nullptr) == 0, "openpty");
  termios raw{};
  tcgetattr(slave, &raw);
  cfmakeraw(&raw);
  tcsetattr(slave, TCSANOW, &raw);
  close(slave);
  fcntl(master_, F_SETFL, O_NONBLOCK);
  std::filesystem::remove(path_);
  std::filesystem::create_symlink(name.data(), path_);
}

SerialDevice::~SerialDevice() {
  close(master_);
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void SerialDevice::send(Bytes bytes) const {
  // Nobody reading makes a full buffer: the instrument goes on talking and the bytes are lost.
  [[maybe_unused]] const auto written = write(master_, bytes.data(), bytes.size());
}

std::string SerialDevice::heard() const {
  std::array<char, 1024> bytes{};
  const auto size = read(master_, bytes.data(), bytes.size());
  return {bytes.data(), size > 0 ? static_cast<std::size_t>(size) : 0U};
}

TcpDevice::TcpDevice(int port) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address = loopback(port);
  check(bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0, "bind");
  check(listen(listener_, 4) == 0, "listen");
  port_ = bound_port(listener_);
}

TcpDevice::~TcpDevice() {
  if (peer_ >= 0) close(peer_);
  close(listener_);
}

void TcpDevice::take_waiting() {
  const int next = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (next < 0) return;
  if (peer_ >= 0) close(peer_);
  peer_ = next;
}

std::string TcpDevice::heard() {
  take_waiting();
  std::array<char, 1024> bytes{};
  const auto size = peer_ < 0 ? 0 : recv(peer_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  return {bytes.data(), size > 0 ? static_cast<std::size_t>(size) : 0U};
}

void TcpDevice::send(Bytes bytes) {
  take_waiting();
  if (peer_ >= 0) ::send(peer_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

int connect_to(int port) {
  const int out = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  if (connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return out;
  close(out);
  return -1;
}

void send_udp(int port, Bytes bytes) {
  const int out = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  sendto(out, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  close(out);
}

bus::ParticipantOptions test_participant(int domain) {
  return presence(static_cast<std::uint32_t>(domain), "test");
}

bool is_in_state(const Collector<ServiceStatus>& status, ServiceState state, const std::string& text) {
  const auto all = status.all();
  return !all.empty() && all.back().state == state && all.back().text.find(text) != std::string::npos;
}

std::uint64_t counter(const Collector<ServiceStatus>& status, std::string_view name) {
  const auto all = status.all();
  if (all.empty()) return 0;
  for (const auto& each : all.back().counters) {
    if (each.name == Name(name)) return each.value;
  }
  return 0;
}

}  // namespace fathom::test
