// SPDX-License-Identifier: BSD-3-Clause
#include "common/html_text.h"

namespace lidar_obstacles::apps {

std::string escaped(const std::string& text) {
    std::string html;
    html.reserve(text.size());
    for (const char c : text) {
        switch (c) {
            case '&':
                html += "&amp;";
                break;
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '"':
                html += "&quot;";
                break;
            default:
                html += c;
        }
    }
    return html;
}

}  // namespace lidar_obstacles::apps
