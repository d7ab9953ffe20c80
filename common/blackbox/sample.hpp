#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "record/bytes.hpp"

namespace fathom::blackbox {

/// Where samples come from: one topic of one writer. A channel of the recording.
struct Origin {
  std::string topic;
  std::string type;         ///< as in the IDL
  std::string writer;       ///< name of its participant
  std::string writer_guid;  ///< hexadecimal
  bool latched = false;     ///< late readers get its last samples: repeated in every file
};

/// A sample as it arrived. Times are the vehicle's.
struct Sample {
  std::uint32_t origin = 0;  ///< index of its Origin
  TimeNs log_ns = 0;         ///< arrival at the recorder
  TimeNs publish_ns = 0;
  record::Bytes bytes;
  std::string key;  ///< of its instance; of latched topics only
};

/// Something to find again: an alarm that came or went, an order.
struct Event {
  TimeNs time_ns = 0;
  std::string kind;   ///< "alarm" or "order"
  std::string text;   ///< one English sentence
  bool keeps = true;  ///< it makes a recorder of events keep what is around it
};

/// A file inside of the recording.
struct Enclosure {
  std::string name;
  std::string media_type;
  TimeNs created_ns = 0;
  record::Bytes data;
  /// Not empty: a file that changes. It is read anew some seconds after this was put in and after each file's
  /// begin, so that what it is about is in the same file; `data` is not used.
  std::string path{};
};

}  // namespace fathom::blackbox
