#include "logs/dataflash/reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/bytes/little_endian.hpp"
#include "logs/dataflash/format.hpp"
#include "logs/file_window.hpp"

namespace fathom::logs::dataflash {
namespace {

constexpr std::size_t kLongest = 255 + kHeaderSize;
constexpr double kLatest_us = 3.9e15;
constexpr std::size_t kHead = 4096;

bool is_format(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kFormatLength && bytes[0] == kHead1 && bytes[1] == kHead2 &&
         bytes[2] == kFormatType && parse_format(bytes.subspan(kHeaderSize)).has_value();
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, const std::set<std::string>& wanted)
      : file_(path), wanted_(wanted) {
    Definition self;
    self.name = "FMT";
    self.length = kFormatLength;
    self.fault = "read by itself";
    types_[kFormatType].definition = self;
  }

  Log read() {
    log_.format = kFormatName;
    std::uint64_t at = 0;
    while (at < file_.size()) {
      // As many as the longest message and what follows it.
      const auto bytes = file_.at(at, 2 * kLongest);
      const std::size_t length = framed(bytes);
      if (length == 0 || !intact(bytes, length)) {
        at = resynchronise(at);
        continue;
      }
      take(at, bytes.subspan(0, length));
      at += length;
    }
    for (Series& one : log_.series) {
      if (const std::size_t stray = drop_stray_times(one); stray > 0)
        log_.losses.add(0, 0, one.label() + ": " + std::to_string(stray) + " rows with times of damage");
    }
    if (log_.messages.size() < 2) {
      throw LogError(file_.name() + ": no messages but definitions, expected an ArduPilot DataFlash log");
    }
    return std::move(log_);
  }

 private:
  struct Type {
    std::optional<Definition> definition;
    std::vector<std::size_t> columns;        // fields that are numbers
    std::map<unsigned, std::size_t> series;  // of each instance
    bool settled = false;
  };

  // The length of the message that begins here; 0 where none does.
  [[nodiscard]] std::size_t framed(std::span<const std::uint8_t> bytes) const {
    if (bytes.size() < kHeaderSize || bytes[0] != kHead1 || bytes[1] != kHead2) return 0;
    const auto& definition = types_[bytes[2]].definition;
    if (!definition || definition->length > bytes.size()) return 0;
    if (bytes[2] == kFormatType && !is_format(bytes)) return 0;
    return definition->length;
  }

  // Bytes are missing inside a message when another one begins in it, and none behind it.
  [[nodiscard]] bool intact(std::span<const std::uint8_t> bytes, std::size_t length) const {
    if (length == bytes.size() || framed(bytes.subspan(length)) > 0) return true;
    for (std::size_t i = kHeaderSize; i < length; ++i) {
      const auto rest = bytes.subspan(i);
      const std::size_t inner = framed(rest);
      if (inner > 0 && i + inner > length && (inner == rest.size() || framed(rest.subspan(inner)) > 0))
        return false;
    }
    return true;
  }

  std::uint64_t resynchronise(std::uint64_t at) {
    std::uint64_t next = at + 1;
    for (; next < file_.size(); ++next) {
      const auto bytes = file_.at(next, 3 * kLongest);
      const std::size_t length = framed(bytes);
      if (length == 0) continue;
      // Garbage looks like one message now and then, like two hardly ever. The last one has none behind it.
      if (length == bytes.size() || framed(bytes.subspan(length)) > 0 || lone(bytes, length)) break;
    }
    next = std::min(next, file_.size());
    const auto bytes = file_.at(at, kHeaderSize);
    const bool begun = bytes.size() == kHeaderSize && bytes[0] == kHead1 && bytes[1] == kHead2;
    std::string what = "bytes that are no message";
    if (begun && next == file_.size() && types_[bytes[2]].definition) {
      what = "a message " + types_[bytes[2]].definition->name + " that the end of the file cuts off";
    } else if (begun && !types_[bytes[2]].definition) {
      what = "a message of the type " + std::to_string(bytes[2]) + ", which no FMT defines";
    }
    log_.losses.add(at, next - at, what);
    return next;
  }

  // A message between garbage: its time is near that of the one before.
  [[nodiscard]] bool lone(std::span<const std::uint8_t> bytes, std::size_t length) const {
    const Definition& d = *types_[bytes[2]].definition;
    if (!d.fault.empty()) return false;
    const auto t_us = time_us(d, bytes.subspan(kHeaderSize, length - kHeaderSize));
    return t_us && std::abs(*t_us - last_us_) < 60e6;
  }

  [[nodiscard]] static std::optional<double> time_us(const Definition& d,
                                                     std::span<const std::uint8_t> payload) {
    // GPS messages before 2014-12 have the receiver's time as TimeMS and ours as T.
    struct Clock {
      const char* label;
      double us;
    };
    const bool early_gps = d.find("T") && d.find("TimeMS") && d.find("Week");
    for (const Clock& clock : {Clock{"TimeUS", 1.0}, Clock{early_gps ? "T" : "TimeMS", 1e3}}) {
      const auto field = d.find(clock.label);
      if (field && !is_text(d.letters[*field]))
        return raw_number(d.letters[*field], payload, d.offsets[*field]) * clock.us;
    }
    return std::nullopt;
  }

  void take(std::uint64_t at, std::span<const std::uint8_t> bytes) {
    Type& type = types_[bytes[2]];
    const auto payload = bytes.subspan(kHeaderSize);
    ++log_.messages[type.definition->name];
    if (bytes[2] == kFormatType) {
      define(at, *parse_format(payload));
      return;
    }
    const Definition& d = *type.definition;
    if (!d.fault.empty()) return;
    const auto t_us = time_us(d, payload);
    if (t_us && *t_us >= 0.0 && *t_us < kLatest_us && wanted_.contains(base_of(d.name).first)) {
      last_us_ = *t_us;
      take_row(type, payload, static_cast<std::int64_t>(*t_us));
    } else if (wanted_.contains(base_of(d.name).first)) {
      log_.losses.add(at, bytes.size(),
                      d.name + (t_us ? " with a time beyond a century" : " without a time"));
    } else {
      take_words(d, payload, t_us.value_or(0.0));
    }
  }

  void define(std::uint64_t at, Defined defined) {
    if (defined.type == kFormatType) return;
    Type& type = types_[defined.type];
    if (!defined.definition.fault.empty()) {
      log_.losses.add(at, 0,
                      "FMT of " + defined.definition.name + ": " + defined.definition.fault +
                          "; its messages are passed");
    }
    if (type.definition && type.definition->name == defined.definition.name &&
        type.definition->letters == defined.definition.letters &&
        type.definition->labels == defined.definition.labels)
      return;  // logs that go on in a new file repeat their definitions
    type = Type{};
    type.definition = std::move(defined.definition);
    const auto units = units_.find(defined.type);
    if (units != units_.end()) {
      type.definition->units = units->second.first;
      type.definition->multipliers = units->second.second;
    }
  }

  // "IMU2" is the instance 1 of "IMU" where logs have no instances.
  [[nodiscard]] std::pair<std::string, unsigned> base_of(const std::string& name) const {
    if (name == "BAR2" || name == "BAR3") return {"BARO", name.back() == '2' ? 1U : 2U};
    if (name == "ASP2") return {"ARSP", 1U};
    if (name.size() > 2 && name.back() >= '2' && name.back() <= '9' &&
        wanted_.contains(name.substr(0, name.size() - 1)))
      return {name.substr(0, name.size() - 1), static_cast<unsigned>(name.back() - '1')};
    return {name, 0U};
  }

  void take_row(Type& type, std::span<const std::uint8_t> payload, std::int64_t t_us) {
    const Definition& d = *type.definition;
    if (!type.settled) {
      for (std::size_t i = 0; i < d.letters.size(); ++i)
        if (!is_text(d.letters[i])) type.columns.push_back(i);
      type.settled = true;
    }
    auto [topic, instance] = base_of(d.name);
    for (const std::size_t i : type.columns) {
      const bool names_instance = (i < d.units.size() && d.units[i] == '#') || d.labels[i] == "I";
      if (!names_instance) continue;
      const double number = raw_number(d.letters[i], payload, d.offsets[i]);
      if (number >= 0.0 && number < 256.0) instance = static_cast<unsigned>(number);
    }
    Series& series = series_of(type, topic, instance);
    series.t_us.push_back(t_us);
    for (const std::size_t i : type.columns) {
      const double raw = raw_number(d.letters[i], payload, d.offsets[i]);
      const bool time = d.labels[i] == "TimeUS" || d.labels[i] == "TimeMS" || d.labels[i] == "SampleUS" ||
                        d.labels[i] == "SMS" || d.labels[i] == "GMS" || d.labels[i] == "T";
      series.values.push_back(time ? raw : raw * scale_of(d, i, letters_));
    }
  }

  Series& series_of(Type& type, const std::string& topic, unsigned instance) {
    const auto known = type.series.find(instance);
    if (known != type.series.end()) return log_.series[known->second];
    type.series[instance] = log_.series.size();
    Series& made = log_.series.emplace_back();
    made.topic = topic;
    made.instance = instance;
    for (const std::size_t i : type.columns) made.columns.push_back(type.definition->labels[i]);
    return made;
  }

  // What a log says of itself and of its autopilot.
  void take_words(const Definition& d, std::span<const std::uint8_t> payload, double t_us) {
    const auto number = [&](const char* label) -> std::optional<double> {
      const auto field = d.find(label);
      if (!field || is_text(d.letters[*field])) return std::nullopt;
      return raw_number(d.letters[*field], payload, d.offsets[*field]);
    };
    const auto letter = [&](const char* label) -> std::optional<char> {
      const auto code = number(label);
      if (!code || !(*code >= 0.0 && *code < 128.0)) return std::nullopt;
      return static_cast<char>(*code);
    };
    const auto text = [&](std::initializer_list<const char*> labels) -> std::string {
      for (const char* label : labels) {
        const auto field = d.find(label);
        if (field && is_text(d.letters[*field]))
          return text_at(d.letters[*field], payload, d.offsets[*field]);
      }
      return {};
    };
    if (d.name == "PARM") {
      if (const auto value = number("Value")) log_.parameters[text({"Name"})] = *value;
    } else if (d.name == "MSG") {
      log_.texts.push_back(
          {static_cast<std::int64_t>(std::clamp(t_us, 0.0, kLatest_us)), 6, text({"Message"})});
      if (!log_.info.contains("firmware")) log_.info["firmware"] = log_.texts.back().text;
    } else if (d.name == "VER") {
      log_.info["firmware_string"] = text({"FWS"});
    } else if (d.name == "MULT") {
      const auto id = letter("Id");
      const auto factor = number("Mult");
      if (id && factor) letters_.multiplier[*id] = *factor;
    } else if (d.name == "UNIT") {
      if (const auto id = letter("Id")) letters_.unit[*id] = text({"Label"});
    } else if (d.name == "FMTU") {
      if (const auto id = number("FmtType"); id && *id >= 0.0 && *id < 256.0) {
        const auto type = static_cast<std::uint8_t>(*id);
        units_[type] = {text({"UnitIds"}), text({"MultIds"})};
        if (auto& definition = types_[type].definition) {
          definition->units = units_[type].first;
          definition->multipliers = units_[type].second;
        }
      }
    } else if (d.name == "DSF") {
      const auto dropped = number("Dp");
      if (dropped && *dropped >= 0.0 && *dropped < 1e15) log_.dropouts = static_cast<std::uint64_t>(*dropped);
    }
  }

  FileWindow file_;
  const std::set<std::string>& wanted_;
  Log log_;
  std::array<Type, 256> types_;
  std::map<std::uint8_t, std::pair<std::string, std::string>> units_;
  Letters letters_;
  double last_us_ = 0.0;
};

}  // namespace

bool looks_like(const std::filesystem::path& path) {
  FileWindow file(path);
  const auto bytes = file.at(0, kHead);
  for (std::size_t i = 0; i + kFormatLength <= bytes.size(); ++i)
    if (is_format(bytes.subspan(i))) return true;
  return false;
}

Log read(const std::filesystem::path& path, const std::set<std::string>& wanted) {
  return Reader(path, wanted).read();
}

}  // namespace fathom::logs::dataflash
