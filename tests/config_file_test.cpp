// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "lidar_obstacles/params_list.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// The complete file with the default values.
std::string defaults() { return dumpParams(DetectorParams{}); }

/// The file with one occurrence of `from` replaced.
std::string with(const std::string& from, const std::string& to) {
    std::string text = defaults();
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the test's line '" + from + "' is not in the file");
    return text.replace(at, from.size(), to);
}

std::string errorOf(const std::string& text) {
    try {
        parseParams(text, "x.ini");
    } catch (const ConfigError& e) {
        return e.what();
    }
    return "no error";
}

std::string setErrorOf(const std::string& assignment) {
    DetectorParams params;
    try {
        setParam(params, assignment);
    } catch (const ConfigError& e) {
        EXPECT_EQ(dumpParams(params), defaults()) << "changed by an assignment that failed";
        return e.what();
    }
    return "no error";
}

/// "x.ini:N: " for the N-th line of the default file, the one that starts with `start`.
std::string placeOf(const std::string& start) {
    std::istringstream in(defaults());
    std::string line;
    for (int n = 1; std::getline(in, line); ++n) {
        if (line.rfind(start, 0) == 0) return "x.ini:" + std::to_string(n) + ": ";
    }
    throw std::logic_error("no line starts with " + start);
}

TEST(ConfigFile, TheFileInTheRepositoryHoldsTheDefaultsOfTheCode) {
    std::ifstream in(LIDAR_OBSTACLES_CONFIG_INI, std::ios::binary);
    const std::string file{std::istreambuf_iterator<char>(in), {}};
    const std::string code = defaults();
    const auto differs = std::mismatch(file.begin(), file.end(), code.begin(), code.end()).first - file.begin();
    EXPECT_TRUE(file == code) << "they differ in line " << 1 + std::count(file.begin(), file.begin() + differs, '\n')
                              << "; write it anew: obstacle-replay --print-config > config.ini";
}

TEST(ConfigFile, WhatIsWrittenReadsBackTheSame) {
    DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, auto& value) {  // some value other than the default
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, double>) {
            value = info.min + (info.max - info.min) / 3.0;
        } else if constexpr (std::is_same_v<T, int>) {
            value = static_cast<int>(info.max);
        } else if constexpr (std::is_same_v<T, bool>) {
            value = !value;
        } else if constexpr (std::is_same_v<T, std::string>) {
            value = std::string(info.section) == "region" ? "box(-2, 3.5, -1, 1, -0.5, 1.5)" : "other/name 1.bt";
        } else {
            value = choices(T{}).back().second;
        }
    });
    DetectorParams read;
    for (const auto& p : listParams(params)) {
        std::ostringstream text;
        text.precision(17);
        std::visit([&](const auto& v) { text << p.section << '.' << p.key << '=' << v; }, p.value);
        setParam(read, text.str());
    }
    EXPECT_EQ(dumpParams(read), dumpParams(params));
    EXPECT_NE(dumpParams(read), defaults());
    EXPECT_EQ(dumpParams(parseParams(defaults(), "x.ini")), defaults());
}

TEST(ConfigFile, EveryParameterIsDescribedAndItsDefaultAllowed) {
    const DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto& value) {
        EXPECT_STRNE(info.text, "") << info.key;
        EXPECT_EQ(std::string(info.text).find('\n'), std::string::npos) << info.key;
        using T = std::decay_t<decltype(value)>;
        if constexpr (!std::is_enum_v<T> && !std::is_same_v<T, std::string>) {
            EXPECT_LE(info.min, value) << info.section << '.' << info.key;
            EXPECT_GE(info.max, value) << info.section << '.' << info.key;
        }
    });
}

TEST(ConfigFile, CommentsBlankLinesCaseAndLineEndingsDoNotMatter) {
    std::string text = with("[grid]", "  [ GRID ]  // section\n\n ; nothing\n// nothing");
    std::string crlf = "\xEF\xBB\xBF";  // byte order mark
    for (const char c : text) crlf += c == '\n' ? "\r\n" : std::string(1, c);
    const auto at = crlf.find("max_range = ");
    crlf.replace(at, crlf.find('\r', at) - at, "\tMax_Range=  77.5 ; metres # far");
    const DetectorParams params = parseParams(crlf, "x.ini");
    EXPECT_EQ(params.sensor.max_range, 77.5);
}

TEST(ConfigFile, TheOwnBodyMayStandInAFileOfItsOwn) {
    const test::TempFolder folder;
    test::writeFile(folder.file("body.txt"), "# learnt\nbox(-1, 2, -0.9, 0.9)\npolygon(2 0, 3 0,\n 2 1)\n");
    DetectorParams params;
    setParam(params, "region.own_body=@" + folder.file("body.txt"));
    EXPECT_EQ(params.region.own_body, "box(-1, 2, -0.9, 0.9) polygon(2 0, 3 0, 2 1)");
    EXPECT_EQ(parseParams(dumpParams(params), "").region.own_body, params.region.own_body);
    test::writeFile(folder.file("body.txt"), "circle(1)");
    const auto errorOfSetting = [&](const std::string& value) {
        try {
            setParam(params, "region.own_body=" + value);
        } catch (const ConfigError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_THAT(errorOfSetting("@" + folder.file("body.txt")), HasSubstr("body.txt: 'circle' is neither"));
    EXPECT_THAT(errorOfSetting("@/nonexistent"), HasSubstr("/nonexistent: cannot open"));
    EXPECT_THAT(errorOfSetting("box(1, 2)"), HasSubstr("[region] own_body = box(1, 2): a box has 4 numbers"));
}

TEST(ConfigFile, OutlineAndExcludedPlacesAreKeptAsTextOrNamedByAFile) {
    const test::TempFolder folder;
    test::writeFile(folder.file("places.txt"), "# a mast\nsector(170, 190)\nbox(-1, 2, -0.9, 0.9)\n");
    DetectorParams params;
    setParam(params, "region.excluded=@" + folder.file("places.txt"));
    EXPECT_EQ(params.region.excluded, "box(-1, 2, -0.9, 0.9) sector(170, 190)");
    setParam(params, "region.outline=polygon(0 0,  9 -3, 9 3)");
    EXPECT_EQ(params.region.outline, "polygon(0 0, 9 -3, 9 3)");
    EXPECT_EQ(dumpParams(parseParams(dumpParams(params), "")), dumpParams(params));
    EXPECT_THAT(setErrorOf("region.outline=sector(1, 2)"),
                AllOf(HasSubstr("[region] outline = sector(1, 2): 'sector' is neither"), HasSubstr("polygon(..)")));
    EXPECT_THAT(setErrorOf("region.excluded=circle(1)"),
                AllOf(HasSubstr("[region] excluded = circle(1): 'circle' is neither"), HasSubstr("sector(..)")));
    EXPECT_THAT(setErrorOf("region.excluded=sector(1)"), HasSubstr("a sector has 2 numbers (azimuth from, to) [deg]"));
}

TEST(ConfigFile, AnUnknownKeyIsRefusedWithLineAndNearestKnownOne) {
    EXPECT_THAT(errorOf(with("max_range = ", "max_rnage = ")),
                AllOf(StartsWith(placeOf("max_range")), HasSubstr("[sensor] max_rnage = "), HasSubstr("'max_range'")));
}

TEST(ConfigFile, AKeyInTheWrongSectionIsPointedToItsOwn) {
    EXPECT_THAT(setErrorOf("grid.max_range=5"),
                AllOf(HasSubstr("[grid] max_range = 5"), HasSubstr("[sensor] max_range")));
}

TEST(ConfigFile, AnUnknownSectionIsRefusedWithLineAndNearestKnownOne) {
    EXPECT_THAT(errorOf(with("[sensor]", "[senser]")),
                AllOf(StartsWith(placeOf("[sensor]")), HasSubstr("[senser]"), HasSubstr("'[sensor]'")));
}

TEST(ConfigFile, AValueThatIsNoNumberIsRefused) {
    for (const std::string bad :
         {"abc", "0,5", "0.5m", "0x10", "1 2", "nan", "inf", "-inf", "1e999", "${X}", "1e", "--1"}) {
        EXPECT_THAT(errorOf(with("max_range = ", "max_range = " + bad + " # was ")),
                    AllOf(StartsWith(placeOf("max_range")), HasSubstr("[sensor] max_range = " + bad + ": "),
                          HasSubstr("1 .. 300 m")));
    }
}

TEST(ConfigFile, AValueThatIsNoIntegerIsRefused) {
    for (const std::string bad : {"3.9", "1e1", "4294967296", "-3", "129"}) {
        EXPECT_THAT(setErrorOf("sensor.planes=" + bad),
                    AllOf(HasSubstr("[sensor] planes = " + bad), HasSubstr("0 .. 128")));
    }
}

TEST(ConfigFile, ALimitIsAllowedAndTheNextNumberIsNot) {
    DetectorParams params;
    setParam(params, "sensor.max_range=300");
    setParam(params, "sensor.max_range=1");
    EXPECT_THAT(setErrorOf("sensor.max_range=300.00001"), HasSubstr("out of range (1 .. 300 m)"));
    EXPECT_THAT(setErrorOf("sensor.max_range=0.9999"), HasSubstr("out of range"));
}

TEST(ConfigFile, AWordThatIsNoChoiceIsRefusedWithTheChoices) {
    EXPECT_THAT(setErrorOf("grid.free=all"), AllOf(HasSubstr("[grid] free = all"), HasSubstr("ground | rays")));
    DetectorParams params;
    setParam(params, "Grid.Free = RAYS");
    EXPECT_EQ(params.grid.free, FreeSpace::Rays);
}

TEST(ConfigFile, ADuplicateKeyIsRefusedWithBothLines) {
    const std::string text = with("max_range = ", "MAX_RANGE = 30\nmax_range = ");
    const std::string first = placeOf("max_range");
    const int line = std::stoi(first.substr(first.find(':') + 1));
    EXPECT_THAT(errorOf(text), AllOf(StartsWith("x.ini:" + std::to_string(line + 1) + ": [sensor] max_range"),
                                     HasSubstr("first in line " + std::to_string(line))));
}

TEST(ConfigFile, AMissingKeyIsNoSilentDefault) {
    EXPECT_THAT(errorOf(with("max_range = ", "# max_range = ")),
                AllOf(StartsWith("x.ini: "), HasSubstr("missing [sensor] max_range")));
    EXPECT_THAT(errorOf(""), AllOf(HasSubstr("[sensor] max_range"), HasSubstr("[grid] free")));
}

TEST(ConfigFile, LinesThatAreNeitherSectionNorAssignmentAreRefused) {
    EXPECT_THAT(errorOf("[sensor]\nhello\n"), AllOf(StartsWith("x.ini:2: hello"), HasSubstr("key = value")));
    EXPECT_THAT(errorOf("[sensor\n"), AllOf(StartsWith("x.ini:1: [sensor"), HasSubstr("']'")));
    EXPECT_THAT(errorOf("max_range = 3\n"),
                AllOf(StartsWith("x.ini:1: max_range"), HasSubstr("before the first [section]")));
    EXPECT_THAT(errorOf("[sensor]\n= 3\n"), AllOf(StartsWith("x.ini:2: "), HasSubstr("no key")));
    EXPECT_THAT(errorOf("[sensor]\nmax_range =\n"),
                AllOf(StartsWith("x.ini:2: [sensor] max_range"), HasSubstr("no value")));
    EXPECT_THAT(errorOf(std::string("\0\x1\x2\xff", 4)), StartsWith("x.ini:1: "));
}

TEST(ConfigFile, FilesThatCannotBeReadAreNamed) {
    const auto error = [](const std::string& file) -> std::string {
        try {
            loadParams(file);
        } catch (const ConfigError& e) {
            return e.what();
        }
        return "no error";
    };
    EXPECT_THAT(error("/nonexistent/config.ini"),
                AllOf(HasSubstr("/nonexistent/config.ini"), HasSubstr("cannot open")));
    EXPECT_THAT(error("/tmp"), AllOf(HasSubstr("/tmp"), HasSubstr("cannot")));
    EXPECT_THAT(error("/dev/zero"), AllOf(HasSubstr("/dev/zero"), HasSubstr("larger than 1 MiB")));
}

TEST(ConfigFile, AnAssignmentNeedsSectionKeyAndValue) {
    for (const char* bad : {"", "planes", "sensor.planes", "planes=4", "sensor.=4", ".planes=4", "sensor planes=1.5"}) {
        EXPECT_NE(setErrorOf(bad), "no error") << bad;
    }
    EXPECT_THAT(setErrorOf("sensor.planes="), HasSubstr("no value"));
}

}  // namespace
}  // namespace lidar_obstacles
