#include "runtime/log.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include <pthread.h>
#include <sched.h>
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace fathom::runtime {
namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::trace:
      return spdlog::level::trace;
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      break;
  }
  return spdlog::level::err;
}

/// Lines that wait for standard error. When it takes none, the oldest give way.
constexpr std::size_t kMostWaiting = 512;
constexpr std::chrono::seconds kPatience(1);

/// Standard error, and how many lines it has taken. A line before which others were lost says how many.
class Writing final : public spdlog::sinks::stderr_sink_mt {
 public:
  void log(const spdlog::details::log_msg& line) override {
    if (const std::size_t lost = pool_->overrun_counter(); lost != said_lost_) {
      const std::string text =
          std::to_string(lost - said_lost_) +
          " lines of this log are lost: whatever reads standard error did not take them in time";
      spdlog::sinks::stderr_sink_mt::log({line.time, {}, line.logger_name, spdlog::level::warn, text});
      said_lost_ = lost;
    }
    spdlog::sinks::stderr_sink_mt::log(line);
    ++taken_;
  }
  /// Before the first line.
  void attach(spdlog::details::thread_pool& pool) { pool_ = &pool; }
  [[nodiscard]] std::size_t taken() const { return taken_; }

 private:
  spdlog::details::thread_pool* pool_ = nullptr;
  std::size_t said_lost_ = 0;  // of the thread that writes
  std::atomic<std::size_t> taken_ = 0;
};

/// Lines are written by a thread of their own, which is in no hurry however this process is scheduled.
void begin_writing() {
  const sched_param plain{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &plain);
  pthread_setname_np(pthread_self(), "log");
}

}  // namespace

bool parse_log_level(std::string_view word, LogLevel& level) {
  static constexpr std::array<std::pair<std::string_view, LogLevel>, 5> kWords{
      {{"trace", LogLevel::trace},
       {"debug", LogLevel::debug},
       {"info", LogLevel::info},
       {"warning", LogLevel::warning},
       {"error", LogLevel::error}}};
  for (const auto& [text, value] : kWords) {
    if (text == word) {
      level = value;
      return true;
    }
  }
  return false;
}

// Not registered with spdlog's registry, which is a global: two services in one test process stay apart.
struct Log::Impl {
  std::shared_ptr<Writing> sink = std::make_shared<Writing>();
  std::shared_ptr<spdlog::details::thread_pool> pool =
      std::make_shared<spdlog::details::thread_pool>(kMostWaiting, 1, begin_writing);
  std::shared_ptr<spdlog::async_logger> logger;
  std::atomic<std::size_t> given = 0;

  void give(LogLevel level, std::string_view text) {
    if (!logger->should_log(to_spdlog(level))) return;
    ++given;
    logger->log(to_spdlog(level), text);
  }
};

Log::Log(std::string_view service, LogLevel level) : impl_(new Impl) {
  impl_->sink->attach(*impl_->pool);
  impl_->logger = std::make_shared<spdlog::async_logger>(std::string(service), impl_->sink, impl_->pool,
                                                         spdlog::async_overflow_policy::overrun_oldest);
  impl_->logger->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %n %l: %v", spdlog::pattern_time_type::utc);
  impl_->logger->set_level(to_spdlog(level));
}

Log::~Log() {
  // A thread that hangs in a write cannot be waited for: it ends with the process.
  if (!flush()) (void)impl_.release();
}

bool Log::flush() {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (impl_->sink->taken() + impl_->pool->overrun_counter() < impl_->given) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

// One message is one line of plain text: names in it may come from the network.
void Log::write(LogLevel level, std::string_view text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (std::none_of(text.begin(), text.end(), is_control)) {
    impl_->give(level, text);
  } else {
    std::string plain(text);
    std::replace_if(plain.begin(), plain.end(), is_control, '?');
    impl_->give(level, plain);
  }
}
void Log::trace(std::string_view text) {
  write(LogLevel::trace, text);
}
void Log::debug(std::string_view text) {
  write(LogLevel::debug, text);
}
void Log::info(std::string_view text) {
  write(LogLevel::info, text);
}
void Log::warning(std::string_view text) {
  write(LogLevel::warning, text);
}
void Log::error(std::string_view text) {
  write(LogLevel::error, text);
}

bool SayOnce::say(Log& log, LogLevel level, std::string_view state, std::string_view text) {
  if (last_ == state) return false;
  last_ = state;
  log.write(level, text);
  return true;
}

}  // namespace fathom::runtime
