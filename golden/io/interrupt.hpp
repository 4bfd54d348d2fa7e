// What a process undoes when it is told to end (Ctrl-C, SIGTERM, a closed terminal): a line on standard error, children
// ended, temporary files removed; then it dies of the same signal, so that the status is 130 or 143. Further signals
// are ignored for two seconds, so that they do not cut that off; later ones end the process at once.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>

namespace quadrille::golden {

/// Handles SIGINT, SIGTERM and SIGHUP on a thread of its own from here on; one that is ignored (nohup) stays so. Call
/// it first in main(): threads that run already would take the signals. Without it the signals do what they always do,
/// and everything below is bookkeeping.
void watch_interrupts();
bool interrupts_watched();

/// Waits for the end when the process has been told to end. To be called before a failure is reported and before
/// main() returns: a failure after a signal is a consequence of it.
void yield_to_interrupt();

/// Names a file or folder that is to be written; until output_written() the line of an interruption says that it was
/// not. Empty names and "-" are ignored.
void announce_output(const std::string& path);
void output_written(const std::string& path);

/// What the line of an interruption says last, such as how to go on. Empty: nothing.
void set_interrupt_hint(std::string hint);

/// Runs `change`, which neither begins nor is cut off during an interruption.
void without_interrupt(const std::function<void()>& change);

/// Within without_interrupt(): a path that an interruption removes, whatever it is, and a child that it ends with all
/// of its process group, which has the child's number.
void remember_temporary(const std::filesystem::path& path);
void forget_temporary(const std::filesystem::path& path);
void remember_child(pid_t pid);
void forget_child(pid_t pid);

}  // namespace quadrille::golden
