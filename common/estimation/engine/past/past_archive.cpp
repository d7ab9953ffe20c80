// What is remembered beyond the horizon, as an archive: the leg of the oldest navigator that is held, and the
// keyframes that it can be asked for.
#include <algorithm>

#include "estimation/engine/past/past.hpp"
#include "estimation/fields/past.hpp"

namespace fathom::estimation {

void Past::layout(archive::Layout& archive) const {
  const Leg leg(setup_->index.size());
  const Keyframe one(setup_->index.size());
  // As if there were a knot.
  const Knot knot;
  archive("leg", leg);
  archive.element("keyframes", 0, one);
  archive("knot", knot);
}

void Past::write(const Leg& leg, archive::Writer& archive) const {
  Leg told = leg;
  told.oldest = oldest(leg);
  archive("leg", told);
  for (std::uint64_t number = told.oldest; number < told.count; ++number) {
    const Keyframe& one = frame(number);
    archive.element("keyframes", number - told.oldest, one);
  }
}

void Past::read(archive::Reader& archive, TimeNs now_ns, Candidate& out) const {
  Leg& leg = out.leg;
  archive("leg", leg);
  archive.open("leg", 0);
  archive.expect(leg.oldest <= leg.count && leg.count - leg.oldest <= kept_ + kForFixes &&
                     leg.count < std::uint64_t{1} << 62,
                 "count", "no more keyframes than are kept");
  const std::uint64_t frames = archive.good() ? leg.count - leg.oldest : 0;
  archive.expect(frames == 0 || (leg.begun_ns <= leg.knot_ns && leg.knot_ns <= now_ns), "knot_ns",
                 "an instant of the past");
  archive.close();
  const int states = setup_->index.size();
  for (std::uint64_t i = 0; i < frames && archive.good(); ++i) {
    Keyframe& one = out.frames.emplace_back(states);
    archive.element("keyframes", i, one);
    if (!archive.good()) return;
    archive.open("keyframes", i);
    const TimeNs before_ns = i == 0 ? one.here.now_ns : out.frames[i - 1].here.now_ns;
    archive.expect(one.here.now_ns >= before_ns && one.here.now_ns <= leg.begun_ns, "here.now_ns",
                   "one behind the other");
    archive.expect(!one.acted || one.fix.after < leg.oldest + i, "fix.after", "an earlier keyframe");
    archive.close();
  }
  archive.expect(frames == 0 || !archive.good() || out.frames.back().here.now_ns == leg.begun_ns, "begun_ns",
                 "the instant of the newest keyframe");
}

void Past::take_over(const Candidate& found, Leg& leg) {
  leg = found.leg;
  made_ = leg.count;
  for (std::size_t i = 0; i < found.frames.size(); ++i) frame(leg.oldest + i) = found.frames[i];
}

}  // namespace fathom::estimation
