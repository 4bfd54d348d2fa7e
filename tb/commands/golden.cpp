// quadrille golden: sets of golden vectors, generated and verified (diff is in golden_diff.cpp).
#include "golden/io/error.hpp"
#include "golden/io/json_report.hpp"
#include "golden/vectors/input_suite.hpp"
#include "golden/vectors/suite.hpp"
#include "model/port/snap.hpp"
#include "tb/commands/commands.hpp"
#include "tb/commands/golden_rtl.hpp"
#include "tb/judge/verify_exact.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/options/shard.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

namespace quadrille::tb {
namespace {

using namespace vectors;

// ---- generate ----

struct GenerateCommandOptions {
  CommonOptions common;
  int level = 1;
  std::uint64_t limit = 0;
  std::vector<std::string> suites;
  std::string out, size, shade, shard;
  InputOptions input;
  StateOptions state;
  bool list = false, force = false;

  /// Anything that only an input of one's own takes.
  bool own_input() const {
    const InputOptions none;
    return inputs_given(input) > 0 || input.count != none.count || input.strict || !input.camera.empty() ||
           !input.view.empty() || !input.up.empty() || !input.save_camera.empty() || !state.spelled().empty() ||
           !size.empty() || !shade.empty();
  }
};

/// The chosen suites in the order of the list; all of them when none is named.
std::vector<const Suite*> choose_suites(const std::vector<std::string>& names) {
  std::vector<std::string> all;
  for (const auto& suite : vectors::suites()) all.push_back(suite->info().name);
  std::vector<bool> wanted(all.size(), names.empty());
  for (const std::string& name : names) wanted[choose("suite", name, all)] = true;
  std::vector<const Suite*> chosen;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (wanted[i]) chosen.push_back(vectors::suites()[i].get());
  return chosen;
}

/// Those of a shard, in the same order.
std::vector<const Suite*> shard_of(const std::vector<const Suite*>& suites, const Shard& shard) {
  if (shard.count > suites.size())
    throw UsageError("--shard: " + std::to_string(suites.size()) +
                     (suites.size() == 1 ? " suite is written; it has no parts"
                                         : " suites are written; at most so many shards have some each"));
  std::vector<const Suite*> part;
  for (std::size_t i = 0; i < suites.size(); ++i)
    if (shard.holds(i)) part.push_back(suites[i]);
  return part;
}

/// The suite of an input of one's own, and the options that name it. Attributes are what the shading needs; where it
/// needs none, the weights.
std::unique_ptr<InputSuite> input_suite(const GenerateCommandOptions& options, const Config& config,
                                        std::string& spelled) {
  if (!options.suites.empty()) throw UsageError("--suite is for the program's own inputs; leave it out with an input");
  if (options.level != 1) throw UsageError("--level is for the program's own inputs; an input is drawn as it is");
  CommonOptions common = options.common;
  if (!options.size.empty()) common.size = options.size;
  DrawState state = options.state.state(common, config);
  DrawInput input = load_input(options.input, options.shade, state, config, common.seed);
  print_remark(input, common);
  adjust_state(input, state);
  if (input.attributes == 0) {
    input.attributes = std::min(4, config.attribute_slots);
    for (WindowQuad& quad : input.quads)
      for (std::size_t i = 0; i < 4; ++i) {
        quad.attribute[i].assign(static_cast<std::size_t>(input.attributes), 0);
        if (i < quad.attribute[i].size()) quad.attribute[i][i] = 1;
      }
  }
  if (input.attributes > config.attribute_slots)
    throw UsageError(input.name + " has " + std::to_string(input.attributes) + " attributes, which is more than " +
                     (static_cast<std::size_t>(input.attributes) > max_attribute_slots
                          ? "the machine can have"
                          : "attribute_slots; --set attribute_slots=" + std::to_string(input.attributes)));
  state.attributes = input.attributes;
  spelled = input.option + " --size " + common.size + options.state.spelled() +
            (options.shade.empty() ? "" : " --shade " + options.shade);
  try {
    return std::make_unique<InputSuite>(std::move(input.quads), state, config);
  } catch (const SnapError& error) {
    throw UsageError(describe(error, input));
  }
}

int generate(const GenerateCommandOptions& options, const std::vector<std::string>& arguments) {
  if (options.list) {
    for (const auto& suite : vectors::suites()) std::printf("%s\n", suite->info().name.c_str());
    return exit_ok;
  }
  if (options.out.empty()) throw UsageError("--out DIR is missing: the directory of the set");
  std::vector<std::string> read = options.input.files();
  read.push_back(options.common.config_file);
  check_outputs({options.input.save_camera, options.common.json}, read);
  GenerateOptions generation;
  generation.level = options.level;
  generation.seed = options.common.seed;
  generation.config = options.common.config();
  generation.limit = options.limit;
  generation.threads = options.common.thread_count();

  SetInfo info{generation.level, generation.seed, generation.config, generation.limit};
  std::unique_ptr<InputSuite> own;
  if (options.own_input()) own = input_suite(options, generation.config, info.input);
  const std::vector<const Suite*> chosen =
      shard_of(own != nullptr ? std::vector<const Suite*>{own.get()} : choose_suites(options.suites),
               Shard::parse(options.shard));
  const Stopwatch start;
  SetWriter writer(options.out, info, options.force);
  Progress progress("golden", chosen.size(), options.common.show_progress());
  std::FILE* text = options.common.text();
  nlohmann::ordered_json report = golden::begin_report(generation.config, generation.seed, arguments);
  report["level"] = generation.level;
  nlohmann::ordered_json& list = report["suites"] = nlohmann::ordered_json::array();
  std::string lines;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Suite& suite = *chosen[i];
    progress.set(i, suite.info().name);
    const Stopwatch suite_start;
    std::uint64_t vectors = 0;
    writer.add(suite.info(), [&](SuiteWriter& out) {
      suite.write(out, generation);
      vectors = out.count("vectors");
    });
    char line[160];
    std::snprintf(line, sizeof line, "%-24s %9llu vectors %8.2f s\n", suite.info().name.c_str(),
                  static_cast<unsigned long long>(vectors), suite_start.seconds());
    lines += line;
    list.push_back({{"suite", suite.info().name}, {"vectors", vectors}, {"seconds", suite_start.seconds()}});
  }
  progress.finish();
  writer.commit(own != nullptr || chosen.size() == vectors::suites().size());
  report["seconds"] = start.seconds();
  if (text != nullptr)
    std::fprintf(text, "%s%s: %zu %s in %.1f s\n", lines.c_str(), options.out.c_str(), chosen.size(),
                 chosen.size() == 1 ? "suite" : "suites", start.seconds());
  if (!options.common.json.empty()) golden::save_json(options.common.json, report);
  return exit_ok;
}

// ---- merge ----

int merge(const std::vector<std::string>& parts, const std::string& out, bool force, bool quiet) {
  std::vector<SetReader> sets;
  for (const std::string& part : parts) {
    sets.emplace_back(part);
    const std::string command = set_command(sets.back().info()), first = set_command(sets.front().info());
    if (command != first)
      throw golden::input_error(sets.back().manifest_file(), 0,
                                "is of the set `" + command + "`, " + sets.front().manifest_file() + " of `" + first +
                                    "`; parts of one set are expected");
  }
  std::map<std::string, SuiteReader> suites;
  for (const SetReader& set : sets)
    for (const std::string& name : set.suites()) {
      SuiteReader reader = set.suite(name);
      require_known(reader);
      const auto [other, added] = suites.emplace(name, reader);
      if (!added && other->second.manifest() != reader.manifest())
        throw golden::input_error(reader.manifest_file(), 0,
                                  "differs from " + other->second.manifest_file() + "; the same suite was expected");
    }
  SetWriter writer(out, sets.front().info(), force);
  std::size_t known = 0;
  for (const auto& suite : vectors::suites()) {
    const auto found = suites.find(suite->info().name);
    if (found == suites.end()) continue;
    writer.copy(found->second);
    ++known;
  }
  if (known < suites.size())
    throw UsageError("golden merge: the set of an input of one's own has one suite and no parts");
  writer.commit(known == vectors::suites().size());
  if (!quiet)
    std::printf("%s: %zu %s of %zu sets\n", out.c_str(), known, known == 1 ? "suite" : "suites", parts.size());
  return exit_ok;
}

void add_merge(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("merge", "Put the sets of shards together");
  command->footer(
      "Every set is checked first, its hashes too; all must be of one level, seed, limit and configuration.\n"
      "The bytes are those of one run.\n\n"
      "Examples:\n"
      "  quadrille golden generate --shard 0/2 --out part0\n"
      "  quadrille golden generate --shard 1/2 --out part1\n"
      "  quadrille golden merge part0 part1 --out vectors");
  struct Options {
    std::vector<std::string> parts;
    std::string out;
    bool force = false, quiet = false;
  };
  const auto options = std::make_shared<Options>();
  command->add_option("sets", options->parts, "The sets of the shards")->type_name("DIR ...")->required();
  writes_folder(command->add_option("--out", options->out, "Directory of the whole set; made if missing"))->required();
  command->add_flag("--force", options->force, "Replace the set that DIR holds");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options, &invocation] {
    invocation.run = [options] { return merge(options->parts, options->out, options->force, options->quiet); };
  });
}

// ---- verify ----

/// Who recomputes the responses. The RTL takes all suites at once.
struct VerifyEngine {
  std::string_view name;
  VerifyResult (*verify)(const Suite& suite, const SuiteReader& reader, unsigned threads);
};

constexpr VerifyEngine engines[] = {
    {"model",
     [](const Suite& suite, const SuiteReader& reader, unsigned threads) { return suite.verify(reader, threads); }},
    {"float", verify_exact},
    {"rtl", nullptr},
};

std::string engine_names() {
  std::string names;
  for (const VerifyEngine& engine : engines) names.append(names.empty() ? "" : ", ").append(engine.name);
  return names;
}

struct VerifyCommandOptions {
  std::string directory, engine = "model", json;
  std::vector<std::string> suites;
  int threads = 0;
  bool quiet = false;
};

int verify(const VerifyCommandOptions& options, const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const VerifyEngine& engine : engines) names.emplace_back(engine.name);
  const VerifyEngine& engine = engines[choose("engine", options.engine, names)];
  check_outputs({options.json}, {});
  CommonOptions common;
  common.threads = options.threads;
  common.json = options.json;
  common.quiet = options.quiet;
  std::FILE* text = common.text();

  const SetReader set(options.directory);
  for (const std::string& name : options.suites) choose("suite of " + options.directory, name, set.suites());
  nlohmann::ordered_json report = golden::begin_report(set.info().config, set.info().seed, arguments);
  report["engine"] = engine.name;
  nlohmann::ordered_json& list = report["suites"] = nlohmann::ordered_json::array();
  // The whole set is read, whatever was chosen of it: hashes, and that every suite is what it says.
  require_known(set);
  std::vector<std::string> chosen, replayable;
  for (const std::string& name : set.suites()) {
    const SuiteReader reader = set.suite(name);
    require_known(reader);
    if (!options.suites.empty() && std::ranges::count(options.suites, name) == 0) continue;
    chosen.push_back(name);
    if (reader.info().module != "none") replayable.push_back(name);
  }
  std::map<std::string, VerifyResult> replayed;
  if (engine.verify == nullptr && !replayable.empty()) replayed = replay_rtl(options.directory, replayable);
  bool ok = true;
  std::uint64_t compared = 0;
  for (const std::string& name : chosen) {
    const Stopwatch start;
    const SuiteReader reader = set.suite(name);
    const Suite& suite = find_suite(name);
    if (engine.verify == nullptr && !replayed.contains(name)) {
      if (text != nullptr) std::fprintf(text, "%s: no RTL\n", name.c_str());
      continue;
    }
    VerifyResult result =
        engine.verify != nullptr ? engine.verify(suite, reader, common.thread_count()) : replayed.at(name);
    if (result.mismatches == 0) {  // else the pictures are those of wrong fragments
      result.first_difference = suite.picture_difference(reader);
      result.mismatches = !result.first_difference.empty();
    }
    compared += result.vectors;
    ok = ok && result.ok();
    list.push_back(
        {{"suite", name},
         {"vectors", result.vectors},
         {"mismatches", result.mismatches},
         {"undefined", result.undefined},
         {"first_difference",
          result.first_difference.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(result.first_difference)},
         {"seconds", start.seconds()}});
    if (text != nullptr) {
      std::fprintf(text, "%s: %llu vectors, %llu mismatches", name.c_str(),
                   static_cast<unsigned long long>(result.vectors), static_cast<unsigned long long>(result.mismatches));
      if (result.undefined > 0)
        std::fprintf(text, ", %llu undefined", static_cast<unsigned long long>(result.undefined));
      std::fprintf(text, "\n");
    }
    if (result.mismatches > 0) std::fprintf(stderr, "quadrille: %s\n", result.first_difference.c_str());
    if (!result.judged()) std::fprintf(stderr, "quadrille: suite %s: no vector was compared\n", name.c_str());
  }
  if (compared == 0) {
    std::fprintf(stderr, "quadrille: no vector was compared\n");
    ok = false;
  }
  report["ok"] = ok;
  if (!options.json.empty()) golden::save_json(options.json, report);
  return ok ? exit_ok : exit_mismatch;
}

void add_generate(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("generate", "Write a set of vectors");
  command->footer(
      "Stimulus and response of every stage and of the machine, as hexadecimal lines for $readmemh with manifests\n"
      "that describe each bit; golden/vectors/README.md has the format. Level 1 of all suites takes seconds and 53 "
      "MB,\n"
      "level 2 about sixty times as much. The same level, seed, limit and configuration give the same bytes\n"
      "everywhere.\n\n"
      "An input of your own (--scene, --mesh, --quads, --stress or --corner) gives one suite, `input`: its vertices\n"
      "as given, the integers of the port, and fragments with their clocks; all of it unless --limit says less.\n"
      "--size, --shade and the draw state go with it. Attributes are those of the shading, or the weights where it\n"
      "needs none.\n\n"
      "Examples:\n"
      "  quadrille golden generate --level 1 --out vectors\n"
      "  quadrille golden generate --suite sqrt --suite weights --set significand_bits=12 --out vectors12\n"
      "  quadrille golden generate --scene bowtie --size 64x64 --out mine\n"
      "  quadrille golden generate --mesh pawn.obj --shade uv --cull back --set significand_bits=16 --out pawn\n"
      "  quadrille golden generate --list-suites");
  const auto options = std::make_shared<GenerateCommandOptions>();
  options->common.add_to(*command, false);
  options->input.add_to(*command);
  options->state.add_to(*command);
  constexpr const char* input_group = "Input";
  command
      ->add_option("--size", options->size, "Viewport of an input in pixels, " + options->common.size + " unless given")
      ->type_name("WxH")
      ->group(input_group);
  command->add_option("--shade", options->shade, "Attributes of an input: those of a shading; default: what suits it")
      ->type_name("MODE")
      ->group(input_group);
  command->add_option("--level", options->level, "1: seconds; 2: about sixty times as much")
      ->check(CLI::Range(1, 2))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--suite", options->suites, "Only this suite; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      ->add_option("--shard", options->shard,
                   "Only part I of N, 0 <= I < N, of the suites; `golden merge` puts them together")
      ->type_name("I/N");
  command->add_option("--seed", options->common.seed, "Seed of everything random")
      ->check(whole_number())
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--limit", options->limit,
                   "About this many vectors a suite, at most " + std::to_string(largest_limit) +
                       "; a draw of the machine ends with the quad that reaches its share. 0: as many as the level has")
      ->check(whole_number(largest_limit))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--threads", options->common.threads,
                   "Threads, 0 for one per processor; the bytes do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  writes_folder(command->add_option("--out", options->out, "Directory of the set; made if missing"));
  command->add_flag("--force", options->force, "Replace the set that DIR holds");
  command->add_flag("--list-suites", options->list, "Print the names of the suites, one a line");
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return generate(*options, invocation.arguments); };
  });
}

void add_verify(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("verify", "Check a set: hashes, then every response recomputed");
  command->footer(
      "Hashes and manifests of the whole set are always checked, responses and pictures of the chosen suites. The\n"
      "engine float judges stages by exact integers and fragments by the truth, without clocks; a vector of which it\n"
      "cannot decide every field counts as undefined, and what it can is compared. Exit status: 0 every vector\n"
      "agrees, 1 a vector or a picture differs, or of a suite nothing was compared, 2 the set is damaged, or no judge\n"
      "knows a suite.\n\n"
      "Examples:\n"
      "  quadrille golden verify vectors\n"
      "  quadrille golden verify vectors --suite weights --json -");
  const auto options = std::make_shared<VerifyCommandOptions>();
  command->add_option("directory", options->directory, "The set")->type_name("DIR")->required();
  command->add_option("--engine", options->engine, "Who recomputes: " + engine_names())
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--suite", options->suites, "Only this suite; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--threads", options->threads, "Threads, 0 for one per processor")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  writes_file(*command, command->add_option("--json", options->json, "Write a JSON report (- for standard output)"),
              "json");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return verify(*options, invocation.arguments); };
  });
}

// ---- seal ----

int seal(const std::string& directory, bool quiet) {
  seal_set(directory);
  const SetReader set(directory);
  std::uint64_t vectors = 0;
  for (const std::string& name : set.suites()) {
    const SuiteReader reader = set.suite(name);
    require_known(reader);
    vectors += reader.lines("response");
  }
  if (!quiet)
    std::printf("%s: %zu %s, %llu vectors sealed\n", directory.c_str(), set.suites().size(),
                set.suites().size() == 1 ? "suite" : "suites", static_cast<unsigned long long>(vectors));
  return exit_ok;
}

void add_seal(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("seal", "Make a set of your own responses comparable");
  command->footer(
      "Copy a set, put what your implementation answers into response.hex (of machine suites beats.hex too), a\n"
      "record a line as in the set or as $writememh writes it, and seal the copy: the records are then written as in\n"
      "the set; hashes, sizes and counts become those of your files. Then `golden diff` compares it with the set and\n"
      "`golden verify` with the engines. Everything else must be as generated; malformed files are refused with file\n"
      "and line, exit status 2. Pictures stay as they are.\n\n"
      "Examples:\n"
      "  quadrille golden seal mine\n"
      "  quadrille golden diff vectors mine");
  struct Options {
    std::string directory;
    bool quiet = false;
  };
  const auto options = std::make_shared<Options>();
  command->add_option("directory", options->directory, "The set")->type_name("DIR")->required();
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->callback(
      [options, &invocation] { invocation.run = [options] { return seal(options->directory, options->quiet); }; });
}

}  // namespace

void add_golden_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("golden", "Golden vectors of every stage and of the machine");
  command->require_subcommand(1);
  command->footer("Examples:\n  quadrille golden generate --level 1 --out vectors\n  quadrille golden verify vectors");
  add_generate(*command, invocation);
  add_merge(*command, invocation);
  add_verify(*command, invocation);
  add_seal(*command, invocation);
  add_golden_diff_command(*command, invocation);
}

}  // namespace quadrille::tb
