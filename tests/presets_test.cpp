// SPDX-License-Identifier: BSD-3-Clause
// The config files for users: each loads, says why it differs from the defaults, and is what the script writes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

constexpr const char* kNames[] = {"car.ini", "delivery-robot.ini", "fixed-post.ini"};

std::string presetFile(const std::string& name) { return std::string(PRESETS) + name; }

/// "section.key" -> "value", as the file format writes them.
std::map<std::string, std::string> valuesOf(const std::string& text) {
    std::map<std::string, std::string> values;
    std::istringstream in(text);
    std::string section;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind('[', 0) == 0) section = line.substr(1, line.size() - 2);
        const auto at = line.find(" = ");
        if (at != std::string::npos && line[0] != '#') values[section + "." + line.substr(0, at)] = line.substr(at + 3);
    }
    return values;
}

/// Does the line before the key's say why?
bool saysWhy(const std::string& text, const std::string& name, const std::string& value) {
    const std::string key = name.substr(name.find('.') + 1);
    const auto at = text.find("\n" + key + " = " + value + "\n");
    const auto before = text.rfind('\n', at - 1);
    return at != std::string::npos && text.compare(before + 1, 7, "# why: ") == 0;
}

TEST(Presets, LoadAndAreComplete) {
    for (const char* name : kNames) {
        EXPECT_EQ(valuesOf(dumpParams(loadParams(presetFile(name)))), valuesOf(test::readFile(presetFile(name))))
            << name;
    }
}

TEST(Presets, SayWhyOfEachDifferenceAndOfNothingElse) {
    const auto defaults = valuesOf(dumpParams(DetectorParams{}));
    for (const char* name : kNames) {
        const std::string text = test::readFile(presetFile(name));
        std::size_t differences = 0;
        for (const auto& [key, value] : valuesOf(text)) {
            if (value == defaults.at(key)) continue;
            ++differences;
            EXPECT_TRUE(saysWhy(text, key, value)) << name << ": " << key;
        }
        std::size_t reasons = 0;
        for (auto at = text.find("\n# why: "); at != std::string::npos; at = text.find("\n# why: ", at + 1)) ++reasons;
        EXPECT_EQ(reasons, differences) << name;
        EXPECT_GT(differences, 0U) << name;
    }
}

TEST(Presets, AreWhatTheScriptWrites) {
    const test::TempFolder folder;
    const std::string command = "OBSTACLE_REPLAY=" OBSTACLE_REPLAY " " SCRIPTS "make_presets.sh " + folder.file("new");
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (const char* name : kNames) {
        EXPECT_EQ(test::readFile(folder.file("new/") + name), test::readFile(presetFile(name)))
            << name << ": run scripts/make_presets.sh";
    }
}

}  // namespace
}  // namespace lidar_obstacles
