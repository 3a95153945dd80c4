// SPDX-License-Identifier: BSD-3-Clause
#include "common/numbered_files.h"

#include <algorithm>
#include <cctype>

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

bool fits(const std::string& file, const NumberedName& name) {
    constexpr std::size_t kDigits = 6;
    const std::size_t ends = name.begin.size() + name.end.size();
    if (file.size() < ends + kDigits || file.compare(0, name.begin.size(), name.begin) != 0 ||
        file.compare(file.size() - name.end.size(), name.end.size(), name.end) != 0)
        return false;
    return std::all_of(file.begin() + static_cast<std::ptrdiff_t>(name.begin.size()),
                       file.end() - static_cast<std::ptrdiff_t>(name.end.size()),
                       [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

void removeNumbered(const fs::path& folder, const std::vector<NumberedName>& names) {
    std::error_code ignored;
    std::vector<fs::path> found;
    for (fs::directory_iterator it(folder, ignored), end; it != end; it.increment(ignored)) {
        const std::string file = it->path().filename().string();
        if (std::any_of(names.begin(), names.end(), [&](const NumberedName& name) { return fits(file, name); }))
            found.push_back(it->path());
    }
    for (const fs::path& file : found) fs::remove(file, ignored);
}

}  // namespace lidar_obstacles::apps
