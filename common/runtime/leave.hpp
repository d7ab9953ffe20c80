#pragma once

namespace fathom::runtime {

/// Ends the process here with this exit code, what was written to standard output and error flushed, and
/// static objects as they are: those of Fast DDS sleep for 0.1 s at the end (RTPSDomain::stopAll), which a
/// service that is started anew would be missing for longer. Whoever calls it has ended everything of his
/// own. In a build with sanitizers it returns `exit_code` for main to return, because they look for leaks at
/// the end.
int leave(int exit_code);

/// The same in every build, and whatever is still running or locked.
[[noreturn]] void abandon(int exit_code);

}  // namespace fathom::runtime
