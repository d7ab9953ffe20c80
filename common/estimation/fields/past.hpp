#pragma once

#include "estimation/engine/past/keyframe.hpp"
#include "estimation/fields/filter.hpp"

/// Fields of what an engine remembers beyond its horizon.
namespace fathom::estimation {

/// How many states there are is the configuration's to say.
template <class Archive, class Self>
void Passage::fields(Archive& archive, Self& self) {
  archive.left_out(self.n_);
  archive("cut", self.cut_);
  for (int i = 0; i < self.n_; ++i) {
    archive.element("gradient", static_cast<std::size_t>(i), self.gradient_[static_cast<std::size_t>(i)],
                    fathom::archive::finite());
    for (int j = 0; j < self.n_; ++j)
      archive.element("transition", at(i, j), self.a_[at(i, j)], fathom::archive::finite());
    for (int j = 0; j <= i; ++j) {
      archive.element("curvature", at(i, j), self.w_[at(i, j)], fathom::archive::finite());
      if constexpr (Archive::kReads) self.w_[at(j, i)] = self.w_[at(i, j)];
    }
  }
  archive.left_out(self.gradient_);
  archive.left_out(self.a_);
  archive.left_out(self.w_);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Knot>
void fields(Archive& archive, Self& self) {
  archive("now_ns", self.now_ns, fathom::archive::kInstant);
  archive("travelled_N_m", self.travelled_N_m, fathom::archive::finite());
  archive("v_N_m_s", self.v_N_m_s, fathom::archive::finite());
  archive("q_NB", self.q_NB);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Track>
void fields(Archive& archive, Self& self) {
  archive("count", self.count, fathom::archive::Whole{0, static_cast<std::int64_t>(Track::kKnots)});
  for (std::size_t i = 0; i < std::min<std::size_t>(self.count, Track::kKnots); ++i)
    archive.element("knots", i, self.knots[i]);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, LateFix>
void fields(Archive& archive, Self& self) {
  archive("after", self.after);
  archive("share", self.share, fathom::archive::within(0.0, 1.0));
  archive("rows", self.rows, fathom::archive::Whole{0, kFixRows});
  archive("h", self.h, fathom::archive::finite());
  archive("sigma", self.sigma, fathom::archive::at_least_zero());
  archive("innovation", self.innovation, fathom::archive::finite());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Keyframe>
void fields(Archive& archive, Self& self) {
  archive("here", self.here);
  archive("position", self.position);
  archive("x", self.x, fathom::archive::within(-1e9, 1e9));
  const int states = self.onward.size();
  for (std::size_t q = 0; q < self.p.size(); ++q)
    for (int j = 0; j < states; ++j)
      archive.element("p", q * kMaxStates + static_cast<std::size_t>(j),
                      self.p[q][static_cast<std::size_t>(j)], fathom::archive::finite());
  archive("acted", self.acted);
  archive("fix", self.fix);
  archive("track", self.track);
  archive("onward", self.onward);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Leg>
void fields(Archive& archive, Self& self) {
  archive("count", self.count);
  archive("oldest", self.oldest);
  archive("begun_ns", self.begun_ns, fathom::archive::kInstant);
  archive("knot_ns", self.knot_ns, fathom::archive::kInstant);
  archive("track", self.track);
  archive("passage", self.passage);
}

}  // namespace fathom::estimation
