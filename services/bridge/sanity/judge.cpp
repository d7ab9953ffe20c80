#include "bridge/sanity/judge.hpp"

#include <cmath>

namespace fathom::bridge {

void Judge::refuse(Refusal why, std::string_view field, const Values& values, std::size_t index, double least,
                   double most) {
  if (verdict_) return;
  verdict_ = Refused{.why = why, .field = field, .value = values.all[index], .least = least, .most = most};
  if (values.all.size() > 1) verdict_->index = index;
}

Judge& Judge::numbers(std::string_view field, const Values& values) {
  for (std::size_t i = 0; i < values.all.size(); ++i) {
    if (!std::isfinite(values.all[i])) refuse(Refusal::not_finite, field, values, i, -kNoLimit, kNoLimit);
  }
  return *this;
}

Judge& Judge::finite(std::string_view field, const Values& values) {
  for (std::size_t i = 0; i < values.all.size(); ++i) {
    if (std::isinf(values.all[i])) refuse(Refusal::not_finite, field, values, i, -kNoLimit, kNoLimit);
  }
  return *this;
}

Judge& Judge::within(std::string_view field, const Values& values, double least, double most) {
  for (std::size_t i = 0; i < values.all.size(); ++i) {
    if (values.all[i] < least || values.all[i] > most)
      refuse(Refusal::impossible, field, values, i, least, most);
  }
  return *this;
}

Judge& Judge::positive(std::string_view field, double value) {
  if (value <= 0.0)
    refuse(Refusal::impossible, field, value, 0, std::numeric_limits<double>::min(), kNoLimit);
  return *this;
}

}  // namespace fathom::bridge
