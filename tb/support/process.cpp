#include "tb/support/process.hpp"

#include "tb/support/environment_error.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <map>
#include <sstream>

extern char** environ;

namespace quadrille::tb {

namespace fs = std::filesystem;

namespace {

/// File actions and argv of one posix_spawn, released at the end of the scope.
struct Spawn {
  posix_spawn_file_actions_t actions;
  Spawn() { posix_spawn_file_actions_init(&actions); }
  ~Spawn() { posix_spawn_file_actions_destroy(&actions); }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;

  pid_t start(std::span<const std::string> argv) {
    std::vector<char*> arguments;
    for (const std::string& a : argv) arguments.push_back(const_cast<char*>(a.c_str()));
    arguments.push_back(nullptr);
    pid_t pid = 0;
    const int error = posix_spawn(&pid, argv.front().c_str(), &actions, nullptr, arguments.data(), environ);
    if (error != 0) throw EnvironmentError("cannot start " + argv.front() + ": " + std::strerror(error));
    return pid;
  }
};

int exit_status(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) return 127;
  }
  return exit_status(status);
}

pid_t start_logged(std::span<const std::string> argv, const fs::path& directory, const fs::path& log) {
  {
    std::ofstream header(log, std::ios::app);
    for (const std::string& a : argv) header << a << ' ';
    header << '\n';
  }
  Spawn spawn;
  posix_spawn_file_actions_addopen(&spawn.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&spawn.actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&spawn.actions, STDOUT_FILENO, STDERR_FILENO);
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
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw EnvironmentError(std::string("cannot open a pipe: ") + std::strerror(errno));
  std::string text;
  int status = 0;
  try {
    Spawn spawn;
    posix_spawn_file_actions_addopen(&spawn.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&spawn.actions, ends[1], STDOUT_FILENO);
    const pid_t pid = spawn.start(argv);
    close(ends[1]);
    ends[1] = -1;
    char buffer[4096];
    for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) != 0;) {
      if (n > 0) text.append(buffer, static_cast<std::size_t>(n));
      if (n < 0 && errno != EINTR) break;
    }
    status = wait_for(pid);
  } catch (...) {
    close(ends[0]);
    if (ends[1] >= 0) close(ends[1]);
    throw;
  }
  close(ends[0]);
  if (status != 0) {
    std::string line;
    for (const std::string& a : argv) line += a + ' ';
    throw EnvironmentError("'" + line + "' ended with status " + std::to_string(status));
  }
  return text;
}

int run_parallel(std::span<const std::vector<std::string>> commands, const fs::path& directory, const fs::path& log,
                 unsigned jobs) {
  // waitpid on exactly our own processes, oldest first: the host program may have children of its own.
  struct Running {
    pid_t pid;
    fs::path log;
  };
  std::deque<Running> running;
  int first_failure = 0;
  const auto collect = [&] {
    const Running oldest = running.front();
    running.pop_front();
    const int status = wait_for(oldest.pid);
    if (first_failure == 0) first_failure = status;
    std::ofstream all(log, std::ios::app);
    std::ifstream one(oldest.log);
    if (one.peek() != std::ifstream::traits_type::eof()) all << one.rdbuf();
  };
  std::size_t next = 0;
  while (next < commands.size() || !running.empty()) {
    const bool may_start = next < commands.size() && first_failure == 0;
    if (may_start && running.size() < (jobs == 0 ? 1 : jobs)) {
      const fs::path own = directory / (std::to_string(next) + ".log");
      running.push_back({start_logged(commands[next], directory, own), own});
      ++next;
    } else if (!running.empty()) {
      collect();
    } else {
      break;
    }
  }
  return first_failure;
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
