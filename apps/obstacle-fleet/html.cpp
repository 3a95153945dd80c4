// SPDX-License-Identifier: BSD-3-Clause
#include "html.h"

namespace lidar_obstacles::fleet {

std::string page(const std::string& title, const std::string& body) {
    return "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>" + escaped(title) +
           "</title>\n<style>body{font:15px/1.45 sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}"
           "h1{font-size:1.6em}h2{margin-top:2em;border-bottom:1px solid #ccc}"
           "table{border-collapse:collapse;margin:.6em 0;font-size:13px}th,td{border:1px solid #ccc;padding:.2em .5em;"
           "text-align:right}th{background:#f2f2f2}th:first-child,td:first-child{text-align:left}"
           ".words td{text-align:left}small{color:#666}</style>\n<h1>" +
           escaped(title) + "</h1>\n" + body + "</html>\n";
}

std::string tableHead(const std::vector<std::string>& cells) {
    std::string row = "<table><tr>";
    for (const std::string& cell : cells) row += "<th>" + cell + "</th>";
    return row + "</tr>\n";
}

std::string tableRow(const std::vector<std::string>& cells) {
    std::string row = "<tr>";
    for (const std::string& cell : cells) row += "<td>" + cell + "</td>";
    return row + "</tr>\n";
}

std::string link(const std::string& file, const std::string& text) {
    return "<a href=\"" + escaped(file) + "\">" + text + "</a>";
}

}  // namespace lidar_obstacles::fleet
