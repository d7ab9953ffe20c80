#include "fusion/order_answers.hpp"

#include <utility>

#include "fusion/order_text.hpp"

namespace fathom::fusion {
namespace {

constexpr DurationNs kNoteStays_ns = 60 * kNsPerSecond;

}  // namespace

void OrderAnswers::note(std::string text) {
  log_.warning(text);
  const std::lock_guard lock(mutex_);
  ++figures_.not_done;
  figures_.note = std::move(text);
  noted_ns_ = clock_.monotonic_ns();
}

void OrderAnswers::refuse(const Command& order, const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    ++figures_.refused;
  }
  note(in_words(order) + ": refused: " + why);
}

void OrderAnswers::tell(const std::vector<estimation::OrderOutcome>& outcomes) {
  for (const estimation::OrderOutcome& one : outcomes) {
    std::string text = in_words(one.order) + ": " + in_words(one) +
                       (one.again ? " (judged anew, after a late measurement)" : "");
    switch (one.fate) {
      case estimation::OrderFate::done:
        log_.info(text);
        break;
      case estimation::OrderFate::not_done:
        note(std::move(text));
        break;
      case estimation::OrderFate::held: {
        log_.warning(text);
        const std::lock_guard lock(mutex_);
        ++figures_.held;
        break;
      }
    }
  }
}

OrderAnswers::Figures OrderAnswers::figures() const {
  const std::lock_guard lock(mutex_);
  Figures out = figures_;
  if (clock_.monotonic_ns() - noted_ns_ > kNoteStays_ns) out.note.clear();
  return out;
}

}  // namespace fathom::fusion
