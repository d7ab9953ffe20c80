#include "runtime/log.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

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
  spdlog::logger logger;
};

Log::Log(std::string_view service, LogLevel level)
    : impl_(
          new Impl{spdlog::logger(std::string(service), std::make_shared<spdlog::sinks::stderr_sink_mt>())}) {
  impl_->logger.set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %n %l: %v", spdlog::pattern_time_type::utc);
  impl_->logger.set_level(to_spdlog(level));
  impl_->logger.flush_on(spdlog::level::trace);
}

Log::~Log() = default;

// One message is one line of plain text: names in it may come from the network.
void Log::write(LogLevel level, std::string_view text) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (std::none_of(text.begin(), text.end(), is_control)) return impl_->logger.log(to_spdlog(level), text);
  std::string plain(text);
  std::replace_if(plain.begin(), plain.end(), is_control, '?');
  impl_->logger.log(to_spdlog(level), plain);
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
