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
    throw UsageError("--shard: " + std::to_string(shard.count) + " shards are more than the number of suites, " +
                     std::to_string(suites.size()));
  std::vector<const Suite*> part;
  for (std::size_t i = 0; i < suites.size(); ++i)
    if (shard.holds(i)) part.push_back(suites[i]);
  return part;
}

/// The suite of an input of one's own, and the options that name it. Attributes are what the shading needs; where it
/// needs none, the weights.
std::unique_ptr<InputSuite> input_suite(const GenerateCommandOptions& options, const Config& config,
                                        std::string& spelled) {
  if (!options.suites.empty())
    throw UsageError("--suite conflicts with a draw of your own (an input, --size, --cull, --shade, …)");
  if (options.level != 1)
    throw UsageError("--level conflicts with a draw of your own (an input, --size, --cull, --shade, …)");
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
  if (options.out.empty()) throw UsageError("--out DIR is missing");
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
                                    "`; expected parts of one set");
  }
  std::map<std::string, SuiteReader> suites;
  for (const SetReader& set : sets)
    for (const std::string& name : set.suites()) {
      SuiteReader reader = set.suite(name);
      require_known(reader);
      const auto [other, added] = suites.emplace(name, reader);
      if (!added && other->second.manifest() != reader.manifest())
        throw golden::input_error(reader.manifest_file(), 0,
                                  "differs from " + other->second.manifest_file() + "; expected the same suite");
    }
  SetWriter writer(out, sets.front().info(), force);
  std::size_t known = 0;
  for (const auto& suite : vectors::suites()) {
    const auto found = suites.find(suite->info().name);
    if (found == suites.end()) continue;
    writer.copy(found->second);
    ++known;
  }
  if (known < suites.size()) throw UsageError("golden merge: a set made from your own input cannot be merged");
  writer.commit(known == vectors::suites().size());
  if (!quiet)
    std::printf("%s: %zu %s of %zu sets\n", out.c_str(), known, known == 1 ? "suite" : "suites", parts.size());
  return exit_ok;
}

void add_merge(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("merge", "Join the sets of shards");
  end_help(*command,
           "All sets need the same level, seed, limit and configuration; their hashes are checked. The bytes equal one "
           "run's.",
           "0 done; 2 usage or input error",
           {"golden generate --shard 0/2 --out part0", "golden generate --shard 1/2 --out part1",
            "golden merge part0 part1 --out vectors"});
  struct Options {
    std::vector<std::string> parts;
    std::string out;
    bool force = false, quiet = false;
  };
  const auto options = std::make_shared<Options>();
  command->add_option("sets", options->parts, "Sets of the shards")->type_name("DIR")->required();
  writes_folder(command->add_option("--out", options->out, "Directory of the joined set; made if missing"))
      ->required()
      ->group(output_group);
  command->add_flag("--force", options->force, "Replace the set in --out")->group(output_group);
  command->add_flag("--quiet", options->quiet, "Print only errors")->group(output_group);
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
  for (const std::string& note : set.info().notes)
    if (!options.quiet) std::fprintf(stderr, "note: %s\n", note.c_str());
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
    if (!result.judged()) std::fprintf(stderr, "quadrille: suite %s: no vectors compared\n", name.c_str());
  }
  if (compared == 0) {
    std::fprintf(stderr, "quadrille: no vectors compared\n");
    ok = false;
  }
  report["ok"] = ok;
  if (!options.json.empty()) golden::save_json(options.json, report);
  return ok ? exit_ok : exit_mismatch;
}

void add_generate(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("generate", "Write a set of vectors");
  end_help(
      *command,
      "A set holds stimulus and response of every stage and of the machine as lines for $readmemh, with manifests "
      "that describe each bit (golden/vectors/README.md). Level 1 takes seconds and 53 MB, level 2 about 60 times "
      "as much. The same options give the same bytes.\n\n"
      "Your own input (--scene, --mesh, --quads, --stress or --corner) gives one suite, `input`. Its attributes "
      "are those of --shade, else the weights.",
      "0 done; 2 usage or input error",
      {"golden generate --level 1 --out vectors", "golden generate --suite sqrt --set significand_bits=12 --out v12",
       "golden generate --mesh pawn.obj --shade uv --cull back --out pawn"});
  const auto options = std::make_shared<GenerateCommandOptions>();
  options->common.add_to(*command, false);
  options->input.add_to(*command);
  add_attributes_option(*command, options->shade);
  options->state.add_to(*command);
  command
      ->add_option("--size", options->size, "Viewport in pixels, of an input (default: " + options->common.size + ")")
      ->type_name("WxH")
      ->group(state_group);
  command->add_option("--level", options->level, "Number of vectors: 1 or 2")
      ->check(CLI::Range(1, 2))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--suite", options->suites, "Only this suite; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--shard", options->shard, "Part I (from 0) of N of the suites; `golden merge` joins them")
      ->type_name("I/N");
  command
      ->add_option("--limit", options->limit,
                   "Vectors per suite, at most " + std::to_string(largest_limit) + "; 0: all of the level")
      ->check(whole_number(largest_limit))
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--list-suites", options->list, "Only print the names of the suites");
  options->common.add_seed_and_threads(*command);
  writes_folder(command->add_option("--out", options->out, "Directory of the set; made if missing"))
      ->group(output_group);
  command->add_flag("--force", options->force, "Replace the set in --out")->group(output_group);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return generate(*options, invocation.arguments); };
  });
}

void add_verify(CLI::App& golden, Invocation& invocation) {
  CLI::App* command = golden.add_subcommand("verify", "Check the hashes of a set and recompute its responses");
  end_help(*command,
           "Hashes and manifests of the whole set are checked, responses and pictures of the chosen suites. Vectors "
           "with fields that the engine float cannot decide count as undefined; their other fields are compared.",
           "0 all vectors agree; 1 difference or no vectors compared; 2 usage or input error (damaged set, unknown "
           "suite), 3 missing tool",
           {"golden verify vectors", "golden verify vectors --suite weights --json -"});
  const auto options = std::make_shared<VerifyCommandOptions>();
  command->add_option("directory", options->directory, "Directory of the set")->type_name("DIR")->required();
  command
      ->add_option("--engine", options->engine,
                   "What recomputes\n"
                   "  model  the model\n"
                   "  float  exact integers for stages, truth for fragments; no clocks\n"
                   "  rtl    the RTL under Verilator")
      ->type_name("ENGINE")
      ->capture_default_str();
  command->add_option("--suite", options->suites, "Only this suite; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--threads", options->threads, "Threads, 0: one per processor")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group(general_group);
  writes_file(*command, command->add_option("--json", options->json, "JSON report; - is standard output"), "json")
      ->group(output_group);
  command->add_flag("--quiet", options->quiet, "Print only errors")->group(output_group);
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
  end_help(*command,
           "Copy a set, write your implementation's answers into response.hex (and beats.hex of machine suites), a "
           "record per line, as in the set or by $writememh. `golden seal` rewrites the records in the set's form and "
           "updates hashes, sizes and counts. Leave the rest as generated; pictures are not checked.",
           "0 done; 2 usage or input error", {"golden seal mine", "golden diff vectors mine"});
  struct Options {
    std::string directory;
    bool quiet = false;
  };
  const auto options = std::make_shared<Options>();
  command->add_option("directory", options->directory, "Directory of the set")->type_name("DIR")->required();
  command->add_flag("--quiet", options->quiet, "Print only errors")->group(output_group);
  command->callback(
      [options, &invocation] { invocation.run = [options] { return seal(options->directory, options->quiet); }; });
}

}  // namespace

void add_golden_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("golden", "Write and check golden vectors of the stages and the machine");
  command->require_subcommand(1);
  end_help(*command, "`quadrille golden COMMAND --help` has the options of a command.",
           "0 done; 1 difference; 2 usage or input error; 3 missing tool",
           {"golden generate --level 1 --out vectors", "golden verify vectors"});
  add_generate(*command, invocation);
  add_merge(*command, invocation);
  add_verify(*command, invocation);
  add_seal(*command, invocation);
  add_golden_diff_command(*command, invocation);
}

}  // namespace quadrille::tb
