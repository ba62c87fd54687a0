#include "analytic/formulas.h"

#include <algorithm>
#include <array>

namespace steradian::analytic {

double point_irradiance(V3 light, V3 p, V3 n) {
    const V3 d = light - p;
    const double d2 = dot(d, d);
    return std::max(0.0, dot(n, d)) / (d2 * std::sqrt(d2));
}

double spot_falloff(double angle, double inner, double outer) {
    const double c_inner = std::cos(radians(inner)), c_outer = std::cos(radians(outer));
    const double t = std::clamp((std::cos(radians(angle)) - c_outer) / (c_inner - c_outer), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

namespace {

/// Sutherland and Hodgman's step for the half-space above the element.
std::vector<V3> above_horizon(const std::vector<V3>& polygon, V3 n) {
    std::vector<V3> out;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const V3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double ha = dot(a, n), hb = dot(b, n);
        if (ha >= 0) out.push_back(a);
        if ((ha < 0) != (hb < 0)) out.push_back(a + (b - a) * (ha / (ha - hb)));
    }
    return out;
}

}  // namespace

double polygon_form_factor(const std::vector<V3>& polygon, V3 p, V3 n) {
    std::vector<V3> seen;
    for (const V3 v : polygon) seen.push_back(v - p);
    seen = above_horizon(seen, n);
    double sum = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        const V3 a = seen[i], b = seen[(i + 1) % seen.size()], c = cross(a, b);
        const double sine = length(c);
        if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(c, n) / sine;
    }
    return std::abs(sum) / (2 * kPi);
}

double parallel_corner_form_factor(double a, double b, double h) {
    const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

double perpendicular_corner_form_factor(double width, double height, double distance) {
    const double slant = std::sqrt(distance * distance + height * height);
    return (std::atan(width / distance) - distance / slant * std::atan(width / slant)) / (2 * kPi);
}

double parallel_disk_form_factor(double r, double h, double offset) {
    const double s = h * h + offset * offset + r * r;
    return 0.5 * (1 - (s - 2 * r * r) / std::sqrt(s * s - 4 * offset * offset * r * r));
}

double perpendicular_disk_form_factor(double r, double height, double distance) {
    const double x = distance / height, y = r / height, z = 1 + x * x + y * y;
    return x / 2 * (z / std::sqrt(z * z - 4 * y * y) - 1);
}

double sphere_form_factor(double r, double distance, double zenith_degrees) {
    return r * r / (distance * distance) * std::cos(radians(zenith_degrees));
}

double setting_sphere_form_factor(double r, double distance) {
    const double sine = r / distance;
    return (std::asin(sine) - sine * std::sqrt(1 - sine * sine)) / kPi;
}

double overhead_ellipsoid_form_factor(double a, double b, double h) { return a * a / (a * a + h * h - b * b); }

double fresnel(double cos_incident, double eta) {
    const double sine2 = (1 - cos_incident * cos_incident) / (eta * eta);
    if (sine2 >= 1) return 1;
    const double cos_transmitted = std::sqrt(1 - sine2);
    const double parallel = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
    const double perpendicular = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

double cauchy_index(double n_d, double abbe, double nanometres) {
    const auto inverse_square = [](double x) { return 1 / (x * x); };
    const double b = (n_d - 1) / abbe / (inverse_square(486.13) - inverse_square(656.27));
    return n_d - b * inverse_square(587.56) + b * inverse_square(nanometres);
}

namespace {

Color positive_response(double nm) {
    const auto lobe = [&](double height, double middle, double left, double right) {
        return height * std::exp(-0.5 * std::pow((nm - middle) / (nm < middle ? left : right), 2));
    };
    const double x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) - lobe(0.065, 501.1, 20.4, 26.2);
    const double y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1);
    const double z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8);
    return {std::max(0.0, 3.2406 * x - 1.5372 * y - 0.4986 * z), std::max(0.0, -0.9689 * x + 1.8758 * y + 0.0415 * z),
            std::max(0.0, 0.0557 * x - 0.2040 * y + 1.0570 * z)};
}

/// The curves have kinks: panels are narrow.
Color integrate_responses(const std::function<double(double)>& f, double from, double to) {
    const auto channel = [&](int c) {
        return integrate([&](double nm) { return f(nm) * positive_response(nm)[c]; }, from, to, 2048);
    };
    return {channel(0), channel(1), channel(2)};
}

Color whole_response() {
    static const Color whole = integrate_responses([](double) { return 1.0; }, 390, 680);
    return whole;
}

}  // namespace

Color integrate_colors(const std::function<double(double)>& f, double from, double to) {
    const Color c = integrate_responses(f, from, to), whole = whole_response();
    return {c.r / whole.r, c.g / whole.g, c.b / whole.b};
}

PrismRay through_prism(double apex, double incident, double eta) {
    PrismRay out;
    out.inside = std::asin(std::sin(incident) / eta);
    const double second = apex - out.inside;
    out.leaves = std::asin(eta * std::sin(second));
    out.deviated = incident + out.leaves - apex;
    out.passed = (1 - fresnel(std::cos(incident), eta)) * (1 - fresnel(std::cos(second), 1 / eta));
    return out;
}

double glass_sphere_radiance(double cos_incident, double eta, int depth) {
    const double r = fresnel(cos_incident, eta);
    return depth < 1 ? 0 : 1 - (1 - r) * std::pow(r, depth - 1);
}

double slab_transmission(double eta, int depth) {
    const double r = fresnel(1, eta);
    double sum = 0;
    for (int j = 0; 2 + 2 * j <= depth; ++j) sum += (1 - r) * (1 - r) * std::pow(r, 2 * j);
    return sum;
}

double hidden_disc_share(double half_angle_degrees, double edge_degrees) {
    const double s = std::sin(radians(half_angle_degrees)), k = std::sin(radians(edge_degrees));
    const double y = std::sqrt((s * s - k * k) / (1 - k * k));  // where the ellipse meets the circle
    const double circle = y * std::sqrt(s * s - y * y) + s * s * std::asin(y / s);
    const double ellipse = k * (y * std::sqrt(1 - y * y) + std::asin(y));
    // Beyond the meeting points all of the circle is hidden where the edge leaves its middle behind.
    const double beyond = k < 0 ? kPi * s * s - 2 * circle : 0;
    return (circle - ellipse + beyond) / (kPi * s * s);
}

double tent_cdf(double x, double radius) {
    const double t = std::clamp(x / radius, -1.0, 1.0);
    return t < 0 ? (1 + t) * (1 + t) / 2 : 1 - (1 - t) * (1 - t) / 2;
}

double gaussian_cdf(double x, double radius) {
    const double sigma = radius / 3, floor = std::exp(-0.5 * 9.0);
    const auto integral = [&](double t) {  // from 0 to t
        return sigma * std::sqrt(kPi / 2) * std::erf(t / (sigma * std::sqrt(2.0))) - floor * t;
    };
    const double t = std::clamp(x, -radius, radius);
    return 0.5 + integral(t) / (2 * integral(radius));
}

double mitchell_cdf(double x, double radius) {
    const auto f = [](double t) {
        constexpr double b = 1.0 / 3, c = 1.0 / 3;
        t = std::abs(t);
        if (t >= 2) return 0.0;
        if (t >= 1)
            return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + 8 * b + 24 * c) / 6;
        return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + 6 - 2 * b) / 6;
    };
    // Cubic pieces between whole numbers, so that five nodes on each are exact.
    const double end = std::clamp(2 * x / radius, -2.0, 2.0);
    double sum = 0;
    for (double a = -2; a < end; a += 1) sum += integrate(f, a, std::min(a + 1, end), 1);
    return sum;
}

double integrate(const std::function<double(double)>& f, double a, double b, int panels) {
    static constexpr std::array<double, 3> kNode{0, 0.538469310105683091, 0.906179845938663993};
    static constexpr std::array<double, 3> kWeight{0.568888888888888889, 0.478628670499366468, 0.236926885056189088};
    const double half = (b - a) / (2 * panels);
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        const double middle = a + (2 * i + 1) * half;
        sum += kWeight[0] * f(middle);
        for (size_t k = 1; k < 3; ++k) sum += kWeight[k] * (f(middle - half * kNode[k]) + f(middle + half * kNode[k]));
    }
    return sum * half;
}

double integrate(const std::function<double(double, double)>& f, double x0, double x1, double y0, double y1,
                 int panels) {
    return integrate([&](double y) { return integrate([&](double x) { return f(x, y); }, x0, x1, panels); }, y0, y1,
                     panels);
}

}  // namespace steradian::analytic
