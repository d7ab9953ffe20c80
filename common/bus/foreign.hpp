#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bus/participant.hpp"
#include "bus/reader.hpp"

/// Topics of others on the same domain, of which this build knows nothing.
namespace fathom::bus {

/// One as discovery tells it.
struct ForeignTopic {
  std::string topic;
  std::string type;  ///< its name alone
  bool keyed = false;
  bool reliable = false;   ///< all its writers offer it
  bool latched = false;    ///< likewise: late readers get the last samples
  bool exclusive = false;  ///< of its writers the strongest counts
};

/// What others write at present and no topic of all_topics() is, in the order of topic and type.
[[nodiscard]] std::vector<ForeignTopic> foreign_topics(Participant& participant);

/// Receives their samples as the bytes that travelled, with their encapsulation header: not decoded, not
/// checked.
class ForeignReader {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t> bytes, const SampleInfo& info)>;

  /// As of Reader: the handler is quick and does not throw. Throws BusError, also where this participant has
  /// the topic with another type already.
  ForeignReader(Participant& participant, const ForeignTopic& topic, Handler handler);
  ~ForeignReader();
  ForeignReader(const ForeignReader&) = delete;
  ForeignReader& operator=(const ForeignReader&) = delete;

  [[nodiscard]] int matched_writers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus
