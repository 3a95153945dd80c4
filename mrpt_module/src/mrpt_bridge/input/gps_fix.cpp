// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/gps_fix.h"

#include <cmath>

namespace lidar_obstacles {
namespace {

using namespace mrpt::obs;

constexpr double kDegree = M_PI / 180.0;
constexpr double kKnot = 1852.0 / 3600.0;  // [m/s]
constexpr double kSlowest = 0.5;           // [m/s]

Eigen::Vector2d radians(double latitude_deg, double longitude_deg) {
    return Eigen::Vector2d(latitude_deg, longitude_deg) * kDegree;
}

void readCourse(double speed, double course_deg, GpsFix& fix) {
    if (speed > kSlowest)
        fix.heading = course_deg * kDegree;
    else
        fix.stands = speed >= 0.0;  // not where it is no number
}

void readNmea(const CObservationGPS& observation, GpsFix& fix) {
    if (observation.hasMsgClass<gnss::Message_NMEA_RMC>()) {
        const auto& rmc = observation.getMsgByClass<gnss::Message_NMEA_RMC>().fields;
        if (rmc.validity_char == 'A') {
            fix.latitude_longitude = radians(rmc.latitude_degrees, rmc.longitude_degrees);
            readCourse(rmc.speed_knots * kKnot, rmc.direction_degrees, fix);
        }
    }
    if (observation.hasMsgClass<gnss::Message_NMEA_VTG>()) {
        const auto& vtg = observation.getMsgByClass<gnss::Message_NMEA_VTG>().fields;
        readCourse(vtg.ground_speed_kmh / 3.6, vtg.true_track, fix);
    }
    if (observation.hasMsgClass<gnss::Message_NMEA_GGA>()) {
        const auto& gga = observation.getMsgByClass<gnss::Message_NMEA_GGA>().fields;
        if (gga.fix_quality == 0) return;
        fix.latitude_longitude = radians(gga.latitude_degrees, gga.longitude_degrees);
        fix.height = gga.altitude_meters;
    }
}

}  // namespace

GpsFix readGps(const CObservationGPS& observation) {
    GpsFix fix;
    if (!observation.hasMsgClass<gnss::Message_NV_OEM6_INSPVAS>()) {
        readNmea(observation, fix);
        return fix;
    }
    const auto& ins = observation.getMsgByClass<gnss::Message_NV_OEM6_INSPVAS>().fields;
    fix.latitude_longitude = radians(ins.lat, ins.lon);
    fix.height = ins.hgt;
    fix.heading = ins.azimuth * kDegree;
    fix.pitch = -ins.pitch * kDegree;  // NovAtel: nose up
    fix.roll = ins.roll * kDegree;     // right side down
    return fix;
}

Eigen::Vector3d eastNorthUp(const Eigen::Vector3d& place, const Eigen::Vector3d& origin) {
    constexpr double kRadius = 6378137.0, kSquaredEccentricity = 6.69437999014e-3;
    const double sine = std::sin(origin.x());
    const double w2 = 1.0 - kSquaredEccentricity * sine * sine;
    const double prime_vertical = kRadius / std::sqrt(w2);
    const double meridian = prime_vertical * (1.0 - kSquaredEccentricity) / w2;
    return {std::remainder(place.y() - origin.y(), 2.0 * M_PI) * (prime_vertical + origin.z()) * std::cos(place.x()),
            (place.x() - origin.x()) * (meridian + origin.z()), place.z() - origin.z()};
}

}  // namespace lidar_obstacles
