#include "fusion/imu_source.hpp"

#include "base/writer_guid.hpp"

namespace fathom::fusion {
ImuSource::Hearing ImuSource::hear(const Name& unit, const WriterGuid& writer, TimeNs now_ns) {
  if (unit != unit_) return Hearing::other_unit;
  if (heard_ && !of_same_process(writer, writer_)) {
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
