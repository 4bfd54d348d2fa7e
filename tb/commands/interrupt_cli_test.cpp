// Ctrl-C and SIGTERM: a line that says what was not written, nothing left behind, no child left running.
#include "tb/commands/cli_fixture.hpp"

#include <fcntl.h>
#include <signal.h>

#include <algorithm>
#include <functional>
#include <map>

namespace {

using namespace quadrille::cli_test;

class InterruptCli : public Cli {
 protected:
  /// Starts the program, sends the signal once `ready` holds, and waits for its end. `environment` as NAME → value.
  int interrupt(const std::vector<std::string>& arguments, int signal, const std::function<bool()>& ready,
                const std::map<std::string, std::string>& environment = {}) const {
    const pid_t pid = ::fork();
    if (pid == 0) {
      std::vector<char*> argv{const_cast<char*>(QUADRILLE_PROGRAM)};
      for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
      argv.push_back(nullptr);
      for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
      for (const int each : {SIGINT, SIGTERM}) ::signal(each, SIG_DFL);
      if (::chdir(file("").c_str()) != 0) ::_exit(99);
      const int err = ::open("stderr", O_WRONLY | O_CREAT | O_TRUNC, 0644), null = ::open("/dev/null", O_RDWR);
      ::dup2(null, 0), ::dup2(null, 1), ::dup2(err, 2);
      ::execv(QUADRILLE_PROGRAM, argv.data());
      ::_exit(98);
    }
    for (int i = 0; i < 60'000 && !ready() && ::waitpid(pid, nullptr, WNOHANG) == 0; ++i) ::usleep(1000);
    EXPECT_TRUE(ready()) << read(file("stderr"));
    ::kill(pid, signal);
    int status = 0;
    ::waitpid(pid, &status, 0);
    return status;
  }

  bool has_temporary(const fs::path& directory) const {
    std::error_code ignored;
    return std::ranges::any_of(fs::directory_iterator(directory, ignored), [](const fs::directory_entry& entry) {
      return entry.path().filename().string().starts_with(".quadrille-");
    });
  }
};

TEST_F(InterruptCli, GoldenGenerate) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const int status = interrupt({"golden", "generate", "--level", "2", "--out", "set"}, signal,
                                 [&] { return has_temporary(file("")); });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);  // 130 and 143 to a shell
    EXPECT_EQ(read(file("stderr")),
              std::string("quadrille: ") + (signal == SIGINT ? "interrupted" : "terminated") + "; not written: set\n");
    EXPECT_FALSE(has_temporary(file("")));
    EXPECT_FALSE(fs::exists(file("set")));
  }
}

TEST_F(InterruptCli, Compare) {
  const int status =
      interrupt({"compare", "--scene", "sphere", "--size", "1024x1024", "--out", "d", "--json", "r.json"}, SIGINT,
                [&] { return has_temporary(file("d")); });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(read(file("stderr")), "quadrille: interrupted; not written: r.json, d\n");
  EXPECT_TRUE(fs::is_empty(file("d")));
}

TEST_F(InterruptCli, ASweepSaysHowToGoOn) {
  const std::vector<std::string> sweep{
      "sweep",  "--size",           "512x512", "--cosim", "none", "--axis", "significand_bits=8:26",
      "--axis", "depth_bits=16:28", "--out",   "d"};
  const int status = interrupt(sweep, SIGINT, [&] { return fs::exists(file("d")) && !fs::is_empty(file("d")); });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_NE(read(file("stderr")).find("kept in d"), std::string::npos) << read(file("stderr"));
}

// A tool that would run for ever, in the middle of a build for the cache.
TEST_F(InterruptCli, ToolsEndAndTheCacheStaysClean) {
  fs::create_directories(file("bin"));
  fs::create_directories(file("cache"));
  write("bin/verilator",
        "#!/bin/sh\n"
        "case \"$*\" in *--version*|*--getenv*) PATH=${PATH#*:} exec verilator \"$@\";; esac\n"
        "sh -c 'echo $$ >\"$OUT.part\"; mv \"$OUT.part\" \"$OUT\"; exec sleep 1000'\n");
  fs::permissions(file("bin/verilator"), fs::perms::owner_all);
  const int status = interrupt({"cosim", "--scene", "bowtie", "--no-alone", "--png", "a.png"}, SIGTERM,
                               [&] { return fs::exists(file("pid")); },
                               {{"PATH", file("bin").string() + ":" + std::getenv("PATH")},
                                {"OUT", file("pid").string()},
                                {"QUADRILLE_CACHE", file("cache").string()}});
  ASSERT_TRUE(WIFSIGNALED(status)) << read(file("stderr"));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  EXPECT_NE(read(file("stderr")).find("quadrille: terminated; not written: a.png\n"), std::string::npos)
      << read(file("stderr"));
  EXPECT_EQ(read(file("stderr")).find("failed"), std::string::npos) << read(file("stderr"));
  EXPECT_TRUE(fs::is_empty(file("cache")));
  const std::string pid = read(file("pid"));
  const std::string state = read("/proc/" + pid.substr(0, pid.find('\n')) + "/stat");
  EXPECT_TRUE(state.empty() || state.find(") Z") != std::string::npos) << state;
}

// What a killed run left goes with the next run in that directory.
TEST_F(InterruptCli, TheNextRunSweeps) {
  const int status = interrupt({"golden", "generate", "--level", "2", "--out", "set"}, SIGKILL,
                               [&] { return has_temporary(file("")); });
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
  EXPECT_TRUE(has_temporary(file("")));
  EXPECT_EQ(run("config --json c.json --quiet").status, 0);
  EXPECT_FALSE(has_temporary(file("")));
}

}  // namespace
