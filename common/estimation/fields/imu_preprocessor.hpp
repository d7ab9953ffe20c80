#pragma once

#include "archive/visitor.hpp"
#include "estimation/engine/imu_preprocessor.hpp"

namespace fathom::estimation {

template <class Archive, class Self>
void ImuPreprocessor::fields(Archive& archive, Self& self) {
  archive.left_out(self.setup_);
  archive("started", self.started_);
  archive("last_ns", self.last_ns_, fathom::archive::kInstant);
  archive("last_received_ns", self.last_received_ns_, fathom::archive::kAnyWhole);
  // Of the sample that is being read: nothing between two.
  archive.left_out(self.rate_);
  archive.left_out(self.force_);
  archive.left_out(self.covered_s_);
  archive("last_rate", self.last_rate_, fathom::archive::finite());
  archive("last_force", self.last_force_, fathom::archive::finite());
  archive("mean_rate_before", self.mean_rate_before_, fathom::archive::finite());
  archive("mean_force_before", self.mean_force_before_, fathom::archive::finite());
  archive("has_before", self.has_before_);
  archive("fault", self.fault_, ImuFault::stale);
  archive("refused_ns", self.refused_ns_, fathom::archive::kInstant);
  archive("refused_in_a_row", self.refused_in_a_row_, fathom::archive::Whole{0, kNewAxis - 1});
  if (archive.since(10)) {
    archive("uncovered_s", self.uncovered_s_, fathom::archive::finite());
    archive("filled_s", self.filled_s_, fathom::archive::finite());
  }
}

}  // namespace fathom::estimation
