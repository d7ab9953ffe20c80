#include "fusion/imu_source.hpp"

#include <algorithm>

namespace fathom::fusion {
namespace {

// A writer that is followed by another one of its process is no other writer.
constexpr std::size_t kParticipant = 12;

bool same_process(const bus::WriterGuid& a, const bus::WriterGuid& b) {
  return std::equal(a.begin(), a.begin() + kParticipant, b.begin());
}

}  // namespace

ImuSource::Hearing ImuSource::hear(const Name& unit, const bus::WriterGuid& writer, TimeNs now_ns) {
  if (unit != unit_) return Hearing::other_unit;
  if (heard_ && !same_process(writer, writer_)) {
    if (now_ns - last_ns_ <= patience_ns_) {
      ++rivals_;
      return Hearing::other_writer;
    }
    ++changes_;
  }
  heard_ = true;
  writer_ = writer;
  last_ns_ = now_ns;
  return Hearing::taken;
}

}  // namespace fathom::fusion
