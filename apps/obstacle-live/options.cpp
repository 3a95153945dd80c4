// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>

#include "common/input_choice.h"
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Finds obstacles in the packets of a VLP-16, Puck Hi-Res, HDL-32E or VLP-32C as they come in.\n"
    "\n"
    "Results are JSON lines, one per scan, on the standard output or to whoever connects to --serve.\n"
    "What is wrong with the stream is told once on the standard error, survived and counted.\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  obstacle-live --listen 192.168.1.10 --source 192.168.1.201\n"
    "      a sensor that sends to this machine's address 192.168.1.10, port 2368; nobody else is listened to\n"
    "  obstacle-live --listen 0.0.0.0 --source 192.168.1.201\n"
    "      a sensor that broadcasts, as Velodynes do out of the box\n"
    "  obstacle-live --serve 127.0.0.1:5000 --to none --record drive.rawlog\n"
    "      results to whoever connects to port 5000; the scans recorded as they come\n"
    "  obstacle-live --serve /run/robot/lidar.sock --to none\n"
    "      the same to clients of a Unix socket\n"
    "  obstacle-live --source 192.168.1.201 --set ego.source=matching\n"
    "      a vehicle that moves and does not know its poses: they are made of the scans\n"
    "  obstacle-live --source 192.168.1.201 --poses :5001\n"
    "      its poses come from another program, a line of JSON each\n"
    "  obstacle-live --listen 0.0.0.0:2368 --sensor-pose 1,0,1.8,0,0,0 --beside 0.0.0.0:2369=-1,0,1.8,180,0,0\n"
    "      two sensors that send to two ports, as one\n"
    "  obstacle-live capture.pcap --speed max\n"
    "      a capture in the place of the sensor\n"
    "\n"
    "Exit code: 0 all went well, also when interrupted (Ctrl-C); 1 the capture is damaged or something cannot be\n"
    "written; 2 the command line or the configuration is not right.\n";

constexpr double kFarthestPlace = 1e7;  // of a map; northings of UTM are as large [m]

/// What `read` gives. @throws UsageError that names the option where it throws.
template <class Read>
auto readFor(const std::string& option, const Read& read) {
    try {
        return read();
    } catch (const std::invalid_argument& e) {
        throw UsageError(option + ' ' + e.what());
    }
}

live::Endpoint readEndpoint(const std::string& option, const std::string& words) {
    return readFor(option, [&] { return live::parseEndpoint(words, {}); });
}

/// "[ADDRESS]:PORT=X,Y,Z,YAW,PITCH,ROLL". @throws UsageError
SensorBeside readBeside(const std::string& words) {
    const auto end = words.find('=');
    if (end == std::string::npos)
        throw UsageError("--beside " + words + ": must be [ADDRESS]:PORT=X,Y,Z,YAW,PITCH,ROLL");
    return {readEndpoint("--beside", words.substr(0, end)), readPose("--beside", words.substr(end + 1))};
}

struct Words {
    std::string speed = "real";
    std::string listen, source, pose, poses, standing, to = "stdout", serve, commands;
    std::vector<std::string> classes, beside;
};

void addInput(CLI::App& app, Options& o, Words& words) {
    app.add_option("CAPTURE", o.capture, "a capture (pcap) instead of the network");
    app.add_option("--speed", words.speed, "of a capture: real or max")
        ->check(CLI::IsMember({"real", "max"}))
        ->capture_default_str();
    app.add_option("--port", o.port,
                   "of a capture: only packets to this UDP port; without, that of the first data packet")
        ->type_name("N")
        ->check(CLI::Range(1, 65535));
    app.add_option("--listen", words.listen, "address and port to bind, default 127.0.0.1:2368")
        ->type_name("ADDRESS[:PORT]");
    app.add_option("--beside", words.beside,
                   "a further sensor, and where it sits on the vehicle [m, deg]; may be given again: its scans join\n"
                   "those of the first")
        ->type_name("[ADDRESS]:PORT=X,Y,Z,YAW,PITCH,ROLL")
        ->allow_extra_args(false);
    app.add_option("--source", words.source, "accept packets of this address only; without, the first sensor heard")
        ->type_name("ADDRESS");
    app.add_option("--cut-azimuth", o.stream.cut_azimuth_deg,
                   "scans begin here, clockwise from the sensor's x axis [deg]; without, behind the vehicle (180), or\n"
                   "where a sensor does not look whose field of view is limited")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--sensor-pose", words.pose, "the sensor on the vehicle [m, deg]; without, the identity")
        ->type_name("X,Y,Z,YAW,PITCH,ROLL");
    app.add_option("--standing-at", words.standing,
                   "the vehicle does not move: its place in the frame of octomap.map [m, deg];\n"
                   "without, nothing is taken to be known of its motion")
        ->type_name("X,Y,Z,YAW,PITCH,ROLL");
    app.add_option(
           "--poses", words.poses,
           "poses of the vehicle come to this UDP port, a line of JSON each: timestamp [s], x, y [m], yaw [rad],\n"
           "and z, pitch, roll where they are known; stamped by the clock of this machine")
        ->type_name("[ADDRESS]:PORT");
    app.add_option("--sensor-label", o.stream.sensor_label, "name of the sensor in recordings")->type_name("LABEL");
    app.add_option("--no-data", o.stream.no_data_after, "report a silence of this length [s]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--queue", o.queue, "scans that may wait for the detector; the oldest is dropped then")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
}

void addOutput(CLI::App& app, Options& o, Words& words) {
    app.add_option("--to", words.to, "results to the standard output: stdout or none")
        ->check(CLI::IsMember({"stdout", "none"}))
        ->capture_default_str();
    app.add_option("--serve", words.serve,
                   "results to every client of this TCP port, or of this Unix socket (a path with a /), as well;\n"
                   "clients choose what they get, and give commands")
        ->type_name("[ADDRESS]:PORT|PATH");
    app.add_option("--commands", words.commands,
                   "whose commands are obeyed (start, stop, parameters, poses): of clients of this machine (local,\n"
                   "the default), of all, of none")
        ->check(CLI::IsMember({"local", "all", "none"}));
    app.add_option("--classes", words.classes, kClassesHelp)
        ->delimiter(',')
        ->type_name("CLASS,..")
        ->allow_extra_args(false);
    app.add_option("--zones", o.zones, "zones to watch: their states stand in each line")->type_name("FILE.yaml");
    app.add_option("--record", o.record, "record the scans while running")->type_name("FILE.rawlog");
    app.add_option("--statistics", o.statistics, "counts and latencies at the end, as JSON")->type_name("FILE");
    app.add_option("--report", o.report_every,
                   "counts and latencies on the standard error this often [s], 0: at the end")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--duration", o.duration, "end after this time [s]")->check(CLI::PositiveNumber);
    app.add_flag("--window", o.window, "show what is found in a window");
    addLookOptions(app, o.look);
}

void addParameters(CLI::App& app, Options& o) {
    app.add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    app.add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
    app.add_option("--planes", o.planes, "keep N of the sensor's rings; same as --set sensor.planes=N")->type_name("N");
    app.set_version_flag("--version", "obstacle-live " LIDAR_OBSTACLES_VERSION);
}

live::Endpoint readPort(const std::string& option, const std::string& word) {
    if (word.find(':') == std::string::npos) throw UsageError(option + " " + word + ": must be [ADDRESS]:PORT");
    return readEndpoint(option, word);
}

ServeOptions readServe(const Words& words, bool zones) {
    ServeOptions serve;
    serve.zones = zones;
    if (words.serve.find('/') != std::string::npos)
        serve.path = words.serve;
    else
        serve.tcp = readPort("--serve", words.serve);
    if (!words.commands.empty())
        serve.commanders = words.commands == "all"    ? Commanders::All
                           : words.commands == "none" ? Commanders::None
                                                      : Commanders::Local;
    return serve;
}

void readWords(const Words& words, Options& o) {
    if (!o.capture.empty() && !words.listen.empty()) throw UsageError("either a CAPTURE or --listen");
    if (!o.capture.empty() && !words.beside.empty()) throw UsageError("--beside is for sensors, not for a CAPTURE");
    for (const std::string& beside : words.beside) o.beside.push_back(readBeside(beside));
    o.pace = words.speed == "max" ? live::Pace::Maximum : live::Pace::Real;
    o.classes = parseClasses(words.classes);
    o.to_stdout = words.to == "stdout";
    if (!words.pose.empty()) o.stream.sensor_pose = readPose("--sensor-pose", words.pose);
    if (!words.standing.empty())
        o.standing_at = toStampedPose(0.0, readPose("--standing-at", words.standing, kFarthestPlace));
    if (!words.listen.empty()) o.listen = readEndpoint("--listen", words.listen);
    if (!words.source.empty()) o.stream.sender = readFor("--source", [&] { return live::parseAddress(words.source); });
    if (!words.poses.empty()) o.poses = readPort("--poses", words.poses);
    if (o.poses && o.standing_at) throw UsageError("either --poses or --standing-at");
    if (!words.serve.empty()) o.serve = readServe(words, !o.zones.empty());
    if (!words.commands.empty() && !o.serve) throw UsageError("--commands needs --serve");
}

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    Words words;
    CLI::App app(kDescription, "obstacle-live");
    app.footer(kFooter);
    addInput(app, o, words);
    addOutput(app, o, words);
    addParameters(app, o);
    if (!parse(app, argc, argv)) return std::nullopt;
    readWords(words, o);
    return o;
}

}  // namespace lidar_obstacles::apps
