// SPDX-License-Identifier: BSD-3-Clause
#include "run_app.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "message_of.h"

namespace lidar_obstacles::apps {

namespace {

/// "; did you mean --pictures?" for a misspelt option among the words that nothing was made of; "" otherwise.
std::string suggestionFor(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* a : {&app, app.get_subcommands().empty() ? &app : app.get_subcommands().front()})
        for (const CLI::Option* option : a->get_options())
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& word : app.remaining(true)) {
        const std::string name = word.rfind("--", 0) == 0 ? nearestName(word.substr(0, word.find('=')), names) : "";
        if (!name.empty()) return "; did you mean " + name + "?";
    }
    return "";
}

}  // namespace

bool parse(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
        return true;
    } catch (const CLI::Success& e) {  // --help, --version
        app.exit(e);
        return false;
    } catch (const CLI::ParseError& e) {
        throw UsageError(e.what() + suggestionFor(app) + " (see " + app.get_name() + " --help)");
    }
}

int runApp(const char* tool, const std::function<int()>& run) {
    const auto report = [tool](int code, const std::string& message) {
        std::fprintf(stderr, "%s: error: %s\n", tool, message.c_str());
        return code;
    };
    try {
        const int code = run();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            return report(code == 0 ? 1 : code, "cannot write to the standard output");
        return code;
    } catch (const UsageError& e) {
        return report(2, e.what());
    } catch (const ConfigError& e) {
        return report(2, e.what());
    } catch (const std::invalid_argument& e) {  // parameters that do not go together or do not fit the input
        return report(2, e.what());
    } catch (const std::bad_alloc&) {
        return report(1, "out of memory");
    } catch (const std::exception& e) {
        return report(1, messageOf(e));
    }
}

}  // namespace lidar_obstacles::apps
