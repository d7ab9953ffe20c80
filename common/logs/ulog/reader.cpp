#include "logs/ulog/reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/bytes/little_endian.hpp"
#include "logs/file_window.hpp"
#include "logs/ulog/message.hpp"

namespace fathom::logs::ulog {
namespace {

constexpr std::array<std::uint8_t, 7> kMagic{0x55, 0x4C, 0x6F, 0x67, 0x01, 0x12, 0x35};
constexpr std::size_t kFileHeader = 16;
// Simulated autopilots count from 1970. A data set has room for a century.
constexpr double kLatest_us = 3.9e15;
constexpr double kHour_us = 3.6e9;
constexpr std::size_t kMostNotes = 100;

bool begins(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, const std::set<std::string>& wanted)
      : file_(path), wanted_(wanted) {}

  Log read() {
    log_.format = "PX4 ULog";
    const auto header = file_.at(0, kFileHeader);
    if (header.size() < kFileHeader || !begins(header)) {
      throw LogError(file_.name() +
                     ": offset 0: no ULog header, expected 55 4C 6F 67 01 12 35, a version and a time");
    }
    log_.info["ulog_version"] = std::to_string(header[7]);
    log_.info["start_us"] = std::to_string(load_le<std::uint64_t>(header, 8));
    std::uint64_t begin = kFileHeader;
    for (const std::uint64_t end : section_ends()) {
      section(begin, end);
      begin = end;
    }
    for (const auto& [name, count] : unknown_types_)
      note(std::to_string(count) + " messages of the type " + name + ", which this reader does not know");
    for (Series& one : log_.series) {
      if (const std::size_t stray = drop_stray_times(one); stray > 0) {
        log_.losses.add(0, 0, one.label() + ": " + std::to_string(stray) + " rows with times of damage");
      }
    }
    return std::move(log_);
  }

 private:
  void note(std::string text) {
    if (log_.notes.size() < kMostNotes) log_.notes.push_back(std::move(text));
  }

  // Where the parts of the file end: what was appended after a crash begins anew, whatever stood before it.
  std::vector<std::uint64_t> section_ends() {
    std::vector<std::uint64_t> ends;
    const Message first = look(file_.at(kFileHeader, kLongestMessage), {});
    if (first.fault == Fault::none && first.type == 'B') {
      for (std::size_t i = 0; i < 8; ++i) {
        const unsigned unknown = first.payload[8 + i] & (i == 0 ? 0xFEU : 0xFFU);
        if (unknown == 0) continue;
        throw LogError(file_.name() + ": offset " + std::to_string(kFileHeader + kHeaderSize + 8 + i) +
                       ": incompatible features " + std::to_string(unknown) +
                       " are set, expected none but appended data (bit 0 of the first byte)");
      }
      const bool appended = (first.payload[8] & 1U) != 0;
      for (std::size_t i = 0; appended && i < 3; ++i) {
        const auto offset = load_le<std::uint64_t>(first.payload, 16 + 8 * i);
        if (offset == 0) continue;
        const std::uint64_t least = ends.empty() ? kFileHeader + first.size() : ends.back();
        if (offset < least || offset >= file_.size()) {
          log_.losses.add(offset, 0,
                          "appended data " + std::to_string(i + 1) + " begins at offset " +
                              std::to_string(offset) + ", expected from " + std::to_string(least) +
                              " and before the end of the file at " + std::to_string(file_.size()));
          continue;
        }
        ends.push_back(offset);
      }
    }
    ends.push_back(file_.size());
    return ends;
  }

  std::span<const std::uint8_t> from(std::uint64_t offset, std::uint64_t end) {
    // Two of the longest: a message and the one behind it, both in one view.
    const std::uint64_t most = std::min<std::uint64_t>(2 * kLongestMessage, end - offset);
    return file_.at(offset, static_cast<std::size_t>(most));
  }

  void section(std::uint64_t offset, std::uint64_t end) {
    while (offset < end) {
      const auto bytes = from(offset, end);
      const Message message = look(bytes, subscriptions_);
      if (message.fault == Fault::none) {
        take(offset, message);
        offset += message.size();
      } else if (message.fault != Fault::cut && followed(bytes, message.size())) {
        pass(offset, message);
        offset += message.size();
      } else {
        offset = resynchronise(offset, end, message);
      }
    }
  }

  // The end of the section, or a message without a fault.
  bool followed(std::span<const std::uint8_t> bytes, std::size_t size) {
    return size == bytes.size() || look(bytes.subspan(size), subscriptions_).fault == Fault::none;
  }

  // Data whose id, length and time all fit: garbage is not like that.
  bool timely(const Message& message) {
    if (message.type != 'D') return false;
    const Layout& layout = *subscriptions_[load_le<std::uint16_t>(message.payload, 0)].layout;
    if (!layout.timestamp) return false;
    const double t_us = number(layout.timestamp->type, message.payload.subspan(2), layout.timestamp->offset);
    return std::abs(t_us - last_us_) < kHour_us;
  }

  // The beginning of a message that the section ends in.
  bool cut_off_behind(std::span<const std::uint8_t> rest) {
    constexpr std::string_view kTypes = "BFIMPQARDLCSO";
    return look(rest, subscriptions_).fault == Fault::cut &&
           (rest.size() < kHeaderSize || kTypes.find(static_cast<char>(rest[2])) != std::string_view::npos);
  }

  // A message that is framed well and cannot be used.
  void pass(std::uint64_t offset, const Message& message) {
    const std::string size = std::to_string(message.payload.size()) + " bytes";
    switch (message.fault) {
      case Fault::unknown_type:
        // The specification lets writers invent them.
        ++unknown_types_[message.type > ' ' && message.type <= '~'
                             ? std::string("'") + message.type + "'"
                             : std::to_string(static_cast<unsigned char>(message.type))];
        return;
      case Fault::unknown_id:
        log_.losses.add(offset, message.size(),
                        "data of the id " + std::to_string(load_le<std::uint16_t>(message.payload, 0)) +
                            ", which no subscription with a format names");
        return;
      case Fault::wrong_length: {
        const Subscription& of = subscriptions_[load_le<std::uint16_t>(message.payload, 0)];
        if (message.payload.size() - 2 > of.layout->size) {
          take(offset, message);  // what it has beyond its format is not ours to know
          return;
        }
        log_.losses.add(offset, message.size(),
                        of.topic + " of " + size + ", expected " + std::to_string(of.layout->least + 2));
        return;
      }
      default:
        log_.losses.add(offset, message.size(),
                        std::string("a message '") + message.type + "' of " + size + " without its content");
    }
  }

  // The next place from which sound messages follow each other.
  std::uint64_t resynchronise(std::uint64_t offset, std::uint64_t end, const Message& at_fault) {
    std::uint64_t next = offset + 1;
    for (; next < end; ++next) {
      const auto bytes = from(next, end);
      const Message message = look(bytes, subscriptions_);
      if (message.fault == Fault::none &&
          (message.type == 'S' || timely(message) || followed(bytes, message.size()) ||
           cut_off_behind(bytes.subspan(message.size()))))
        break;
    }
    next = std::min(next, end);
    log_.losses.add(offset, next - offset,
                    next == end && at_fault.fault == Fault::cut
                        ? "a message that the end of the file or of its section cuts off"
                        : "bytes that are no message");
    return next;
  }

  void take(std::uint64_t offset, const Message& message) {
    const auto& payload = message.payload;
    switch (message.type) {
      case 'D':
        take_data(offset, payload);
        break;
      case 'F': {
        Result<Format> format = parse_format(text_of(payload));
        if (format) {
          formats_[format.value().name] = std::move(format.value());
          resolve();
        } else {
          log_.losses.add(offset, message.size(), format.error().message);
        }
        break;
      }
      case 'A':
        subscribe(offset, payload);
        break;
      case 'R':
        break;  // ids are never given again
      case 'I': {
        const auto pair = key_value(payload, 0);
        log_.info[pair->key.name] = value_text(*pair);
        break;
      }
      case 'M': {
        const auto pair = key_value(payload, 1);
        auto& list = log_.lists[pair->key.name];
        if (payload[0] == 1 && !list.empty()) {
          list.back() += value_text(*pair);
        } else {
          list.push_back(value_text(*pair));
        }
        break;
      }
      case 'P':
        if (const auto pair = key_value(payload, 0); const auto value = value_number(*pair))
          log_.parameters[pair->key.name] = *value;
        break;
      case 'L':
        say(payload[0], load_le<std::uint64_t>(payload, 1), text_of(payload.subspan(9)));
        break;
      case 'C':
        say(payload[0], load_le<std::uint64_t>(payload, 3), text_of(payload.subspan(11)));
        break;
      case 'O':
        ++log_.dropouts;
        log_.dropout_ms += load_le<std::uint16_t>(payload, 0);
        break;
      default:
        break;  // synchronisation, flags, defaults of parameters
    }
  }

  void say(std::uint8_t level, std::uint64_t t_us, std::string_view text) {
    LoggedText& line = log_.texts.emplace_back();
    line.t_us = static_cast<std::int64_t>(std::min<std::uint64_t>(t_us, std::uint64_t{1} << 52U));
    line.level = level >= '0' ? level - '0' : level;
    for (const char c : text) line.text += static_cast<unsigned char>(c) >= ' ' ? c : ' ';
  }

  void subscribe(std::uint64_t offset, std::span<const std::uint8_t> payload) {
    Subscription one;
    one.instance = payload[0];
    one.topic = std::string(text_of(payload.subspan(3)));
    Result<Layout> layout = layout_of(formats_, one.topic);
    if (!layout) {
      log_.losses.add(offset, kHeaderSize + payload.size(), one.topic + ": " + layout.error().message);
    } else {
      one.layout = std::move(layout.value());
      if (wanted_.contains(one.topic)) one.series = series_of(one);
    }
    log_.messages[one.topic];
    subscriptions_[load_le<std::uint16_t>(payload, 1)] = std::move(one);
  }

  // Subscriptions that came before their format.
  void resolve() {
    for (auto& [id, one] : subscriptions_) {
      if (one.layout) continue;
      Result<Layout> layout = layout_of(formats_, one.topic);
      if (!layout) continue;
      one.layout = std::move(layout.value());
      if (wanted_.contains(one.topic)) one.series = series_of(one);
    }
  }

  // 1 + its place: 0 is none. The same topic subscribed to once more goes on where it was.
  std::size_t series_of(const Subscription& one) {
    std::vector<std::string> columns;
    for (const auto& column : one.layout->columns) columns.push_back(column.name);
    for (std::size_t i = 0; i < log_.series.size(); ++i) {
      const Series& known = log_.series[i];
      if (known.topic == one.topic && known.instance == one.instance && known.columns == columns)
        return i + 1;
    }
    Series& made = log_.series.emplace_back();
    made.topic = one.topic;
    made.instance = one.instance;
    made.columns = std::move(columns);
    return log_.series.size();
  }

  void take_data(std::uint64_t offset, std::span<const std::uint8_t> payload) {
    const Subscription& of = subscriptions_[load_le<std::uint16_t>(payload, 0)];
    ++log_.messages[of.topic];
    const auto body = payload.subspan(2);
    const auto& timestamp = of.layout->timestamp;
    const double t_us = timestamp ? number(timestamp->type, body, timestamp->offset) : -1.0;
    if (!(t_us >= 0.0 && t_us < kLatest_us)) {
      if (of.series == 0) return;
      log_.losses.add(offset, kHeaderSize + payload.size(),
                      of.topic + (timestamp ? " with a time beyond a century" : " without a time"));
      return;
    }
    last_us_ = t_us;
    if (of.series == 0) return;
    Series& series = log_.series[of.series - 1];
    series.t_us.push_back(static_cast<std::int64_t>(t_us));
    for (const auto& column : of.layout->columns) {
      // What is missing at the end is padding, which has no column.
      series.values.push_back(number(column.type, body, column.offset));
    }
  }

  FileWindow file_;
  const std::set<std::string>& wanted_;
  Log log_;
  std::map<std::string, Format> formats_;
  Subscriptions subscriptions_;
  double last_us_ = 0.0;  // of the data before
  std::map<std::string, std::uint64_t> unknown_types_;
};

}  // namespace

bool looks_like(const std::filesystem::path& path) {
  FileWindow file(path);
  return begins(file.at(0, kMagic.size()));
}

Log read(const std::filesystem::path& path, const std::set<std::string>& wanted) {
  return Reader(path, wanted).read();
}

}  // namespace fathom::logs::ulog
