#pragma once

#include "archive/visitor.hpp"
#include "samples/header.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, SampleHeader>
void fields(Archive& archive, Self& self) {
  archive("vehicle", self.vehicle);
  archive("sensor", self.sensor);
  archive("stamp_ns", self.stamp_ns, fathom::archive::kAnyWhole);
  archive("received_ns", self.received_ns, fathom::archive::kAnyWhole);
  archive("sequence", self.sequence);
}

}  // namespace fathom
