// SPDX-License-Identifier: BSD-3-Clause
#include "exports/replay_page.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "common/nameless_file.h"
#include "exports/foxglove.h"

namespace lidar_obstacles::apps {

/// A file of apps/exports/page, compiled in.
std::string pageText(std::string_view name);

namespace {

constexpr const char* kScripts[] = {"data.js", "math.js", "view.js", "plots.js", "labels.js", "panel.js", "main.js"};

/// Text between two marks of the page: where style, data and scripts go.
struct Template {
    std::string before_style, before_data, before_script, end;
};

Template readTemplate() {
    const std::string page = pageText("page.html");
    Template parts;
    std::size_t at = 0;
    for (const auto& [mark, text] : {std::pair("/*style*/", &parts.before_style),
                                     {"<!--data-->", &parts.before_data},
                                     {"/*script*/", &parts.before_script}}) {
        const std::size_t place = page.find(mark, at);
        *text = page.substr(at, place - at);
        at = place + std::strlen(mark);
    }
    parts.end = page.substr(at);
    return parts;
}

/// JSON that no browser takes for the end of a script.
std::string scriptSafe(const nlohmann::ordered_json& json) {
    std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
    return text;
}

void writeAll(int file, const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t n = ::write(file, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw std::runtime_error(temporaryFolder() + ": cannot write: " + std::strerror(errno));
        done += static_cast<std::size_t>(n);
    }
}

}  // namespace

/// How many returns each scan may show, and bytes for all scans.
struct ReplayPage::Room {
    std::size_t points;
    std::size_t bytes;
};

ReplayPage::ReplayPage(const std::filesystem::path& file, const PageLimits& limits)
    : file_(file), limits_(limits), out_(file), begins_{0} {
    try {
        spool_ = openNamelessFile();
    } catch (const std::exception&) {
        out_.discard();
        throw;
    }
}

ReplayPage::~ReplayPage() {
    if (spool_ >= 0) ::close(spool_);
    if (!finished_) out_.discard();
}

void ReplayPage::add(const ScanOutput& scan) {
    const std::string bytes = toBytes(pageScan(scan, limits_.points));
    writeAll(spool_, bytes);
    begins_.push_back(begins_.back() + bytes.size());
    returns_ += scan.found.cloud.size();
}

PageScan ReplayPage::scanAt(std::size_t place) const {
    std::string bytes(begins_[place + 1] - begins_[place], '\0');
    for (std::size_t done = 0; done < bytes.size();) {
        const auto offset = static_cast<off_t>(begins_[place] + done);
        const ssize_t n = ::pread(spool_, bytes.data() + done, bytes.size() - done, offset);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) throw std::runtime_error(temporaryFolder() + ": cannot read: " + std::strerror(n ? errno : EIO));
        done += static_cast<std::size_t>(n);
    }
    return pageScanOf(bytes);
}

ReplayPage::Room ReplayPage::roomFor(const std::vector<std::size_t>& kept) const {
    constexpr std::size_t kSamples = 16, kRounds = 6, kFewest = 500;
    Room room{limits_.points, limits_.bytes};
    const std::size_t step = std::max<std::size_t>(1, kept.size() / kSamples);
    for (std::size_t round = 0; round < kRounds; ++round) {
        std::size_t bytes = 0, most = 0, samples = 0;
        for (std::size_t k = step / 2; k < kept.size(); k += step, ++samples) {
            const PageScan scan = scanAt(kept[k]);
            bytes += packed(scan, room.points).size() + 1;
            most = std::max(most, scan.points.size());
        }
        room.points = std::min(room.points, std::max(most, kFewest));
        const double share = static_cast<double>(room.bytes) * static_cast<double>(samples) /
                             (static_cast<double>(bytes) * static_cast<double>(kept.size()));
        if (samples == 0 || share >= 1.0 || room.points <= kFewest) break;
        room.points = std::max(kFewest, static_cast<std::size_t>(0.98 * share * static_cast<double>(room.points)));
    }
    return room;
}

std::size_t ReplayPage::writeScans(const std::vector<std::size_t>& kept, const Room& room) {
    std::size_t written = 0, points = 0;
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const PageScan scan = scanAt(kept[k]);
        // Scans that pack worse than the samples take from the room of those behind them, but never more than there is.
        const std::size_t fair = (room.bytes - std::min(room.bytes, written)) / (kept.size() - k);
        std::size_t count = std::min(room.points, scan.points.size());
        std::string line = packed(scan, count);
        for (int tries = 0; tries < 6 && line.size() > fair * 5 / 4 && count > 0; ++tries)
            line = packed(scan, count = count * 3 / 4);
        points += count;
        written += line.size() + 1;
        out_.append(line + "\n");
    }
    return points;
}

void ReplayPage::write(const PageTitle& title) {
    const std::size_t scans = begins_.size() - 1;
    const std::size_t every = std::max<std::size_t>(1, (scans + limits_.scans - 1) / limits_.scans);
    std::vector<std::size_t> kept;
    kept.reserve(scans / every + 1);
    for (std::size_t k = 0; k < scans; k += every) kept.push_back(k);
    std::string rows = "[";
    for (const std::size_t k : kept) rows += (rows.size() > 1 ? "," : "") + scanAt(k).row;
    rows = deflated(rows + "]");
    Template page = readTemplate();
    out_.append(page.before_style + pageText("page.css") + page.before_data +
                "<script type=\"text/plain\" id=\"rows\">" + rows + "</script>\n" +
                "<script type=\"text/plain\" id=\"scans\">\n");
    Room room = roomFor(kept);
    room.bytes -= std::min(room.bytes, rows.size());
    const std::size_t points = writeScans(kept, room);
    const nlohmann::ordered_json meta = {{"program", title.program}, {"input", title.input}, {"note", title.note},
                                         {"scans", scans},           {"every", every},       {"returns", returns_},
                                         {"points", points},         {"step", kPageStep}};
    std::string scripts;
    for (const char* name : kScripts) scripts += pageText(name) + "\n";
    out_.append("</script>\n<script type=\"application/json\" id=\"meta\">" + scriptSafe(meta) + "</script>\n" +
                page.before_script + scripts + page.end);
}

void ReplayPage::finish(const PageTitle& title) {
    try {
        write(title);
        out_.close();
    } catch (const std::exception&) {
        // Half a page is none.
        std::error_code ignored;
        out_.discard();
        std::filesystem::remove(file_, ignored);
        finished_ = true;
        throw;
    }
    finished_ = true;
}

}  // namespace lidar_obstacles::apps
