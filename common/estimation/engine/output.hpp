#pragma once

#include "estimation/navigator/navigator.hpp"
#include "samples/alignment_status.hpp"
#include "samples/nav_detail.hpp"
#include "samples/verdict.hpp"

namespace fathom::estimation {

/// What the navigator says of itself, as samples. Headers are left to the caller.
void fill(const Setup& setup, const Navigator& navigator, NavState& out);
void fill(const Setup& setup, const Navigator& navigator, NavDetail& out);
void fill(const Setup& setup, const Navigator& navigator, AlignmentStatus& out);

/// What is published of a judgement, under the header of the sample judged. The first of its measurement, and
/// not final, unless the caller says otherwise.
[[nodiscard]] Verdict verdict_of(const SampleHeader& header, SourceKind source, const Judgement& judgement);

}  // namespace fathom::estimation
