#pragma once

#include "archive/covariance.hpp"
#include "archive/values.hpp"
#include "estimation/filter/error_filter.hpp"

/// Fields of the estimate and its covariance.
namespace fathom::estimation {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, NavSolution>
void fields(Archive& archive, Self& self) {
  archive("position", self.position);
  archive("v_N_m_s", self.v_N_m_s, fathom::archive::within(-1e5, 1e5));
  archive("q_NB", self.q_NB);
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, FilterState>
void fields(Archive& archive, Self& self) {
  archive("nav", self.nav);
  archive("x", self.x, fathom::archive::within(-1e9, 1e9));
}

/// One triangle: both halves are equal to the bit. How many states there are is the configuration's to say.
/// What an older state does not hold shares nothing with the rest (HeldStates).
template <class Archive, class Self>
void ErrorFilter::fields(Archive& archive, Self& self) {
  archive.left_out(self.tape_);
  const int held = self.held_.of(archive);
  int states = held;
  archive("states", states, fathom::archive::Whole{held, held});
  archive.left_out(self.n_);
  archive.left_out(self.estimated_);
  archive.left_out(self.held_);
  if constexpr (Archive::kReads) self.p_.fill(0.0);
  for (int i = 0; i < held; ++i)
    for (int j = 0; j <= i; ++j) {
      auto& here = self.p_[self.at(i, j)];
      archive.element("p", self.at(i, j), here, fathom::archive::finite());
      if constexpr (Archive::kReads) self.p_[self.at(j, i)] = here;
    }
  archive.left_out(self.p_);
  if constexpr (Archive::kReads)
    archive.expect(
        fathom::archive::is_covariance(self.p_.data(), static_cast<std::size_t>(self.n_), kRowStride), "p",
        "a positive covariance");
}

}  // namespace fathom::estimation
