#include "tb/support/process.hpp"

#include "golden/io/interrupt.hpp"
#include "tb/support/environment_error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <sstream>

extern char** environ;

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// File actions and attributes of one posix_spawn, released at the end of the scope.
struct Spawn {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  Spawn() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    if (!golden::interrupts_watched()) return;
    // In a process group of its own a child and its children end when this program ends them, and never before: a
    // Ctrl-C would look like a failing tool. Signals are blocked here, and must not be there.
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  }
  ~Spawn() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;

  pid_t start(std::span<const std::string> argv) {
    std::vector<char*> arguments;
    for (const std::string& a : argv) arguments.push_back(const_cast<char*>(a.c_str()));
    arguments.push_back(nullptr);
    pid_t pid = 0;
    int error = 0;
    golden::without_interrupt([&] {
      error = posix_spawn(&pid, argv.front().c_str(), &actions, &attributes, arguments.data(), environ);
      if (error == 0 && golden::interrupts_watched()) golden::remember_child(pid);
    });
    if (error == ENOENT) throw EnvironmentError("cannot start " + argv.front() + ": " + std::strerror(error));
    if (error != 0) throw SystemError("cannot start " + argv.front() + ": " + std::strerror(error));
    return pid;
  }
};

int exit_status(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

int wait_for(pid_t pid) {
  // Its number is nobody else's until the second wait.
  siginfo_t info{};
  while (waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  golden::without_interrupt([&] { golden::forget_child(pid); });
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) return 127;
  }
  return exit_status(status);
}

/// Both ends of a pipe, closed at the end of the scope.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_, O_CLOEXEC) != 0) throw SystemError(std::string("cannot open a pipe: ") + std::strerror(errno));
  }
  ~Pipe() {
    close(ends_[0]);
    close_write_end();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_write_end() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }
  /// Appends what there is; false at the end.
  bool read_some(std::string& text) const {
    char buffer[4096];
    const ssize_t n = read(ends_[0], buffer, sizeof buffer);
    if (n > 0) text.append(buffer, static_cast<std::size_t>(n));
    return n > 0 || (n < 0 && errno == EINTR);
  }

 private:
  int ends_[2];
};

/// Standard output goes to `out`, if given, instead of the log.
pid_t start_logged(std::span<const std::string> argv, const fs::path& directory, const fs::path& log, int out = -1) {
  {
    std::ofstream header(log, std::ios::app);
    for (const std::string& a : argv) header << a << ' ';
    header << '\n';
  }
  Spawn spawn;
  posix_spawn_file_actions_addopen(&spawn.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&spawn.actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&spawn.actions, STDOUT_FILENO, STDERR_FILENO);
  if (out >= 0) posix_spawn_file_actions_adddup2(&spawn.actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_addchdir_np(&spawn.actions, directory.c_str());
  return spawn.start(argv);
}

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

fs::path find_program(std::string_view program, std::string_view package) {
  const fs::path given(program);
  if (given.has_parent_path()) {
    if (is_program(given)) return given;
  } else if (const char* path = std::getenv("PATH")) {
    std::istringstream directories{path};
    for (std::string directory; std::getline(directories, directory, ':');) {
      const fs::path candidate = fs::path(directory.empty() ? "." : directory) / given;
      if (is_program(candidate)) return fs::absolute(candidate);
    }
  }
  throw EnvironmentError("'" + std::string(program) + "' was not found in PATH; on Debian: apt-get install " +
                         std::string(package));
}

int run_logged(std::span<const std::string> argv, const fs::path& directory, const fs::path& log) {
  return wait_for(start_logged(argv, directory, log));
}

std::string run_captured(std::span<const std::string> argv) {
  Pipe pipe;
  Spawn spawn;
  posix_spawn_file_actions_addopen(&spawn.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&spawn.actions, pipe.write_end(), STDOUT_FILENO);
  const pid_t pid = spawn.start(argv);
  pipe.close_write_end();
  std::string text;
  while (pipe.read_some(text)) {
  }
  if (const int status = wait_for(pid); status != 0) {
    std::string line;
    for (const std::string& a : argv) line += a + ' ';
    throw EnvironmentError("'" + line + "' ended with status " + std::to_string(status));
  }
  return text;
}

int run_watched(std::span<const std::string> argv, const fs::path& directory, const fs::path& log,
                const std::function<void(std::string_view)>& line, const std::function<void()>& tick) {
  Pipe pipe;
  const pid_t pid = start_logged(argv, directory, log, pipe.write_end());
  pipe.close_write_end();
  std::ofstream all(log, std::ios::app);
  std::string text;
  for (bool open = true; open;) {
    pollfd ready{pipe.read_end(), POLLIN, 0};
    constexpr int second = 1000;  // ms
    if (poll(&ready, 1, second) > 0) open = pipe.read_some(text);
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
      all << text.substr(0, end + 1) << std::flush;
      line(std::string_view(text).substr(0, end));
    }
    tick();
  }
  all << text;
  return wait_for(pid);
}

std::string tail_of(const fs::path& file, std::size_t lines) {
  std::ifstream in(file);
  std::deque<std::string> last;
  for (std::string line; std::getline(in, line);) {
    if (line.size() > 400) line.resize(400);
    last.push_back(line);
    if (last.size() > lines) last.pop_front();
  }
  std::string text;
  for (const std::string& line : last) text += "  " + line + '\n';
  return text;
}

}  // namespace quadrille::tb
