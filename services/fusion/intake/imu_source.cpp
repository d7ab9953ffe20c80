#include "fusion/intake/imu_source.hpp"

namespace fathom::fusion {

ImuSource::Answer ImuSource::take(const Name& unit, const WriterGuid& writer, TimeNs now_ns) {
  if (unit != unit_) return Answer::other_unit;
  if (begun_ && !of_same_process(writer, writer_)) {
    if (now_ns - last_ns_ <= patience_ns_) {
      ++rivals_;
      return Answer::other_writer;
    }
    ++changes_;
  }
  begun_ = true;
  writer_ = writer;
  last_ns_ = now_ns;
  return Answer::taken;
}

}  // namespace fathom::fusion
