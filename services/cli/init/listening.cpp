#include "cli/init/listening.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <thread>

#include "cli/command.hpp"
#include "runtime/serial/serial_holders.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array kBauds{115'200, 9'600, 38'400, 921'600, 57'600, 19'200, 4'800, 230'400, 460'800};
// In this order, all rates of one before the next. Seven bits with parity are seen in the eighth bit of 8N1.
constexpr std::array kFramings{runtime::Framing::n8_1, runtime::Framing::e8_1, runtime::Framing::o8_1};
constexpr double kDwell_s = 2.5;       // at one rate, from the first byte
constexpr double kSlowDwell_s = 25.0;  // where something was understood
constexpr double kCount_s = 8.0;       // to count a rate, from where the instrument was recognised

int port_number(const std::string& text, const std::string& whole, const char* form) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || end != text.data() + text.size() || port < 1 || port > 65'535)
    throw Failure(ExitCode::bad_configuration,
                  "init: " + whole + ": expected " + form + ", a port from 1 to 65535");
  return port;
}

/// Seven data bits with parity, as a line of eight without hears them: the eighth bit makes the parity of
/// every byte the same.
class SevenBits {
 public:
  explicit SevenBits(bool possible) {
    if (possible) recognizer_ = std::make_unique<Recognizer>();
  }
  void feed(std::span<const std::uint8_t> bytes, TimeNs now_ns) {
    if (!recognizer_) return;
    std::vector<std::uint8_t> stripped(bytes.begin(), bytes.end());
    for (std::uint8_t& byte : stripped) {
      odd_ += static_cast<std::uint64_t>(std::popcount(byte) % 2);
      ++count_;
      byte &= 0x7f;
    }
    if (count_ > kFew && !framing())
      recognizer_.reset();
    else
      recognizer_->feed(stripped, now_ns);
  }
  [[nodiscard]] std::optional<runtime::Framing> framing() const {
    constexpr double kAll = 0.98;
    const double odd = static_cast<double>(odd_);
    const double count = static_cast<double>(count_);
    if (!recognizer_ || count_ < kFew) return std::nullopt;
    if (odd > kAll * count) return runtime::Framing::o7_1;
    if (odd < (1.0 - kAll) * count) return runtime::Framing::e7_1;
    return std::nullopt;
  }
  [[nodiscard]] std::optional<Recognition> best() const {
    return framing() ? recognizer_->best() : std::nullopt;
  }

 private:
  static constexpr std::uint64_t kFew = 64;
  std::unique_ptr<Recognizer> recognizer_;
  std::uint64_t count_ = 0;
  std::uint64_t odd_ = 0;
};

class Listening {
 public:
  Listening(PortToHear port, const Clock& clock) : port_(std::move(port)), clock_(clock) { open(); }

  /// Goes on to the next rate where it is time. True as soon as nothing more is to be learnt.
  bool step() {
    const TimeNs now = clock_.monotonic_ns();
    const std::lock_guard lock(mutex_);
    const bool recognised = recognizer_->best() || seven_bits_.best();
    if (recognised && recognised_ns_ == 0) recognised_ns_ = now;
    if (recognised) return to_seconds(now - recognised_ns_) >= kCount_s;
    recognised_ns_ = 0;
    const bool serial = port_.port.type == runtime::SourceType::serial;
    if (!serial || port_.baud_known || first_byte_ns_ == 0) return false;
    const double dwell_s = recognizer_->promising() ? kSlowDwell_s : kDwell_s;
    next_rate_ = to_seconds(now - first_byte_ns_) >= dwell_s;
    return false;
  }
  /// Apart from step(), because the source's thread must not wait for a lock that is held here.
  void turn() {
    if (!next_rate_) return;
    next_rate_ = false;
    source_.reset();
    bytes_before_ += recognizer_->bytes();
    open();
  }

  [[nodiscard]] Heard heard() {
    const runtime::SourceStatus status = source_->status();
    source_.reset();
    Heard out{port_.port, bytes_before_ + recognizer_->bytes(), recognizer_->best(), ""};
    if (status.state == runtime::SourceState::lost) out.trouble = status.detail;
    if (const auto framing = seven_bits_.framing(); !out.recognition && seven_bits_.best()) {
      out.recognition = seven_bits_.best();
      out.port.framing = *framing;
    }
    return out;
  }

 private:
  void open() {
    source_.reset();
    recognizer_ = std::make_unique<Recognizer>();
    const bool serial = port_.port.type == runtime::SourceType::serial;
    seven_bits_ = SevenBits(serial);
    first_byte_ns_ = 0;
    if (serial && !port_.baud_known) {
      port_.port.baud = kBauds[rate_ % kBauds.size()];
      port_.port.framing = kFramings[rate_ / kBauds.size() % kFramings.size()];
      ++rate_;
    }
    source_ = std::make_unique<runtime::ByteSource>(
        port_.port, clock_,
        [this](std::span<const std::uint8_t> bytes, const runtime::Arrival&) {
          const std::lock_guard lock(mutex_);
          const TimeNs now = clock_.monotonic_ns();
          if (first_byte_ns_ == 0) first_byte_ns_ = now;
          recognizer_->feed(bytes, now);
          seven_bits_.feed(bytes, now);
        },
        [](const runtime::SourceEvent&) {});
    source_->start();
  }

  PortToHear port_;
  const Clock& clock_;
  std::mutex mutex_;
  std::unique_ptr<Recognizer> recognizer_;
  SevenBits seven_bits_{false};
  TimeNs first_byte_ns_ = 0;
  TimeNs recognised_ns_ = 0;
  std::size_t rate_ = 0;
  bool next_rate_ = false;
  std::uint64_t bytes_before_ = 0;
  std::unique_ptr<runtime::ByteSource> source_;  // last: its thread uses the rest
};

}  // namespace

PortToHear serial_port(const std::string& text) {
  PortToHear out;
  out.port.type = runtime::SourceType::serial;
  const auto at = text.rfind('@');
  out.port.path = fs::absolute(text.substr(0, at)).lexically_normal().string();
  if (at != std::string::npos) {
    const std::string rate = text.substr(at + 1);
    const auto [end, error] = std::from_chars(rate.data(), rate.data() + rate.size(), out.port.baud);
    if (error != std::errc() || end != rate.data() + rate.size() || out.port.baud < 1200 ||
        out.port.baud > 4'000'000)
      throw Failure(ExitCode::bad_configuration,
                    "init: --serial " + text + ": expected PATH or PATH@BAUD, a rate from 1200 to 4000000");
    out.baud_known = true;
  }
  return out;
}

PortToHear tcp_port(const std::string& text) {
  PortToHear out;
  out.port.type = runtime::SourceType::tcp_client;
  const auto colon = text.rfind(':');
  out.port.address = text.substr(0, colon);
  if (colon == std::string::npos || !runtime::is_numeric_address(out.port.address))
    throw Failure(
        ExitCode::bad_configuration,
        "init: --tcp " + text + ": expected ADDRESS:PORT with a numeric address, e.g. 192.168.1.20:16171");
  out.port.port = port_number(text.substr(colon + 1), "--tcp " + text, "ADDRESS:PORT");
  return out;
}

PortToHear udp_port(const std::string& text) {
  PortToHear out;
  out.port.type = runtime::SourceType::udp;
  const auto colon = text.rfind(':');
  out.port.address = colon == std::string::npos ? "0.0.0.0" : text.substr(0, colon);
  if (!runtime::is_numeric_address(out.port.address))
    throw Failure(
        ExitCode::bad_configuration,
        "init: --udp " + text + ": expected PORT or ADDRESS:PORT with a numeric address of this host");
  out.port.port =
      port_number(colon == std::string::npos ? text : text.substr(colon + 1), "--udp " + text, "PORT");
  return out;
}

std::vector<PortToHear> serial_ports_here() {
  std::vector<std::string> paths;
  std::vector<fs::path> named;  // what the lasting names stand for
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/dev/serial/by-id", error)) {
    paths.push_back(entry.path().string());
    named.push_back(fs::canonical(entry.path(), error));
  }
  for (const auto& entry : fs::directory_iterator("/dev", error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("ttyUSB") && !name.starts_with("ttyACM") && !name.starts_with("ttyAMA")) continue;
    if (std::find(named.begin(), named.end(), entry.path()) == named.end())
      paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<PortToHear> out;
  for (const std::string& path : paths) {
    PortToHear port;
    port.port.type = runtime::SourceType::serial;
    port.port.path = path;
    out.push_back(std::move(port));
  }
  return out;
}

void refuse_ports_in_use(const std::vector<PortToHear>& ports) {
  for (const PortToHear& one : ports) {
    if (one.port.type != runtime::SourceType::serial) continue;
    const std::string occupant = runtime::serial_occupant(one.port.path);
    if (!occupant.empty())
      throw Failure(
          ExitCode::bad_configuration,
          "init: " + one.port.path + ": is in use by " + occupant +
              ", from which listening would take bytes; expected a port that nobody else reads: end "
              "that first, or name other ports with --serial");
  }
}

std::vector<Heard> listen(const std::vector<PortToHear>& ports, double most_s, const Clock& clock) {
  std::vector<std::unique_ptr<Listening>> all;
  for (const PortToHear& port : ports) all.push_back(std::make_unique<Listening>(port, clock));
  const TimeNs end = clock.monotonic_ns() + from_seconds(most_s);
  while (clock.monotonic_ns() < end) {
    bool done = true;
    for (const auto& one : all) {
      done = one->step() && done;
      one->turn();
    }
    if (done) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::vector<Heard> out;
  for (const auto& one : all) out.push_back(one->heard());
  return out;
}

}  // namespace fathom::cli
