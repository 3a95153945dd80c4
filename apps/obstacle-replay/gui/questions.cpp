// SPDX-License-Identifier: BSD-3-Clause
// Questions that keys ask: what is typed, and what the answer does.
#include <filesystem>
#include <stdexcept>

#include "common/text_file.h"
#include "controls.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/zones_file.h"

namespace lidar_obstacles::apps {

namespace {

/// Windows tell the key and whether shift is down: what that makes of it, on a keyboard as in the US.
char charOf(const KeyPress& key) {
    const auto c = static_cast<char>(key.code);
    if (!key.shift) return c;
    if (c >= 'a' && c <= 'z') return static_cast<char>(c - 'a' + 'A');
    return c == '-' ? '_' : c == ';' ? ':' : c == '=' ? '+' : c;
}

}  // namespace

void Controls::ask(Question question) {
    if (question == Question::Value && !view_.panel) return;
    if (question == Question::SaveZonesAs && player_->setup().zones.zones.empty())
        throw std::invalid_argument("there are no zones: --zones FILE gives some");
    question_ = question;
    typed_ = question == Question::SaveAs ? "config.ini" : question == Question::SaveZonesAs ? zones_file_ : "";
    type({0, false});
}

/// A key while a question is open. The code 0 only writes the question.
void Controls::type(const KeyPress& key) {
    if (key.code == kEnter) return answer();
    if (key.code == kEscape) {
        if (question_ == Question::Overwrite) view_.message = "nothing is written: " + file_ + " is as it was";
        question_ = Question::None;
        return view_.prompt.clear();
    }
    if (key.code == kBackspace && !typed_.empty()) typed_.pop_back();
    if (key.code >= ' ' && key.code < 127) {
        typed_ += charOf(key);
    }
    view_.prompt = questionText();
    view_.prompt += typed_ + "_";
}

std::string Controls::questionText() const {
    switch (question_) {
        case Question::Jump:
            return "jump to scan (120) or time (12.5s, 1:05): ";
        case Question::Value:
            return panel_.chosen() + " = ";
        case Question::SaveAs:
            return "save the parameters as: ";
        case Question::SaveZonesAs:
            return "save the zones as: ";
        case Question::Overwrite:
            return file_ + " is there already: overwrite it? y, enter: ";
        case Question::None:
            break;
    }
    return "";
}

void Controls::answer() {
    const Question question = question_;
    question_ = Question::None;
    view_.prompt.clear();
    if (typed_.empty() && question != Question::Overwrite) return;
    if (question == Question::Jump) player_->jump(typed_);
    if (question == Question::Value) setParams(panel_.typed(params_.params(), typed_));
    if (question == Question::SaveAs || question == Question::SaveZonesAs) saveUnlessThere(question, typed_);
    if (question == Question::Overwrite && typed_ == "y") return save(saved_, file_);
    if (question == Question::Overwrite) view_.message = "nothing is written: " + file_ + " is as it was";
}

/// A file that is there already is written only after a yes.
void Controls::saveUnlessThere(Question what, const std::string& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return save(what, file);
    saved_ = what;
    file_ = file;
    ask(Question::Overwrite);
}

void Controls::save(Question what, const std::string& file) {
    const bool zones = what == Question::SaveZonesAs;
    writeTextFile(file, zones ? zonesText(player_->setup().zones) : dumpParams(params_.params()));
    view_.message = (zones ? "zones written to " : "parameters written to ") + file;
}

}  // namespace lidar_obstacles::apps
