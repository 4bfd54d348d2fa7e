// The report of `quadrille stress`: shards of it put together, and what is made of it, a table and text.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// "a,b" as {"a", "b"}.
std::vector<std::string> names_in_list(const std::string& list);

/// A command that draws the pixel, for a shell. With an engine: by that one, with truth and errors.
std::string reproduce_pixel(const WindowQuad& quad, const Config& config, int width, int height, int x, int y,
                            std::string_view engine = {});

/// Reads the reports of all shards of one command, in any order, and puts them together: the bytes are those of one run
/// without --shard. Throws golden::InputError with the file for one that is no report of a shard, is of another
/// command, or of a shard that is there twice, and for shards that are missing.
nlohmann::ordered_json merge_stress(const std::vector<std::string>& files);

/// A row for each step and body.
std::string stress_csv(const nlohmann::ordered_json& report);

/// A line for each family, what fails for each body, and each body's worst weight with the command that draws it.
void print_stress(std::FILE* text, const nlohmann::ordered_json& report);

}  // namespace quadrille::tb
