// Closed forms in double precision: what the renderer's pictures are compared with. Nothing here uses the renderer.
//
// Form factors F are of a surface element towards a uniform Lambertian emitter of radiance L: the irradiance is π L F,
// the radiance that a diffuse element of reflectance ρ reflects is ρ L F.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace steradian::analytic {

inline constexpr double kPi = std::numbers::pi;

struct V3 {
    double x = 0, y = 0, z = 0;
};
inline V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V3 operator*(V3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(V3 a) { return std::sqrt(dot(a, a)); }
inline V3 normalized(V3 a) { return a * (1 / length(a)); }
inline double radians(double degrees) { return degrees * (kPi / 180); }

/// Three channels of whatever is expected.
struct Color {
    double r = 0, g = 0, b = 0;
    Color() = default;
    Color(double grey) : r(grey), g(grey), b(grey) {}
    Color(double r_in, double g_in, double b_in) : r(r_in), g(g_in), b(b_in) {}
    double operator[](int c) const { return c == 0 ? r : c == 1 ? g : b; }
};
inline Color operator*(Color c, double s) { return {c.r * s, c.g * s, c.b * s}; }
inline Color operator*(Color a, Color b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }

// --- Light without an extent -----------------------------------------------------------------------------------

/// Irradiance at p with unit normal n from a point of intensity 1: the inverse square law times Lambert's cosine.
double point_irradiance(V3 light, V3 p, V3 n);
/// Smoothstep t² (3 - 2t) with t = (cos θ - cos outer) / (cos inner - cos outer), clamped to [0, 1].
double spot_falloff(double angle_degrees, double inner_degrees, double outer_degrees);

/// Share of the irradiance from an even disc of half angle α that a half plane hides from a surface which faces the
/// disc's middle; the half plane's straight edge is at `edge_degrees` from the middle, in [-α, α], negative where more
/// than half is hidden. Along the axis (Nusselt) the disc becomes a circle of radius sin α, and the edge an ellipse
/// x = sin(edge) √(1 - y²).
double hidden_disc_share(double half_angle_degrees, double edge_degrees);

// --- Form factors ----------------------------------------------------------------------------------------------

/// Any planar polygon, clipped at the horizon of the element: Lambert 1760, F = 1/2π Σ Γ_k · n, where Γ_k points along
/// v_k × v_{k+1} and is as long as the angle between the two. Either orientation.
double polygon_form_factor(const std::vector<V3>& polygon, V3 p, V3 n);
/// Element below a corner of a parallel rectangle a × b at distance h (Howell's catalogue, B-4).
double parallel_corner_form_factor(double a, double b, double h);
/// Element in the plane of the lower edge of a perpendicular rectangle: opposite a lower corner, at a distance; the
/// rectangle is `width` wide and `height` high (Howell's catalogue, B-5).
double perpendicular_corner_form_factor(double width, double height, double distance);
/// Disk of radius r parallel to the element, its centre h above and `offset` beside it (Howell's catalogue, B-13).
double parallel_disk_form_factor(double r, double h, double offset);
/// Disk in a plane perpendicular to the element's: its centre `height` above the element's plane, its plane at
/// `distance`; wholly above the horizon (Howell's catalogue, B-15).
double perpendicular_disk_form_factor(double r, double height, double distance);
/// Sphere wholly above the horizon, its centre at `distance` in a direction `zenith_degrees` from the normal.
double sphere_form_factor(double r, double distance, double zenith_degrees);
/// Sphere whose centre is on the horizon, so that half of it counts: (σ - sin σ cos σ) / π with sin σ = r / distance,
/// the area of a circular segment by Nusselt's projection.
double setting_sphere_form_factor(double r, double distance);
/// Ellipsoid of revolution straight overhead, semi-axes a across and b along the normal: its tangent cone has
/// tan² σ = a² / (h² - b²), and F = sin² σ.
double overhead_ellipsoid_form_factor(double a, double b, double h);

// --- Interfaces ------------------------------------------------------------------------------------------------

/// Fresnel's equations, unpolarised; eta is transmitted over incident index. 1 beyond the critical angle.
double fresnel(double cos_incident, double eta);
/// The index at a wavelength in nanometres by Cauchy's formula, n = A + B / λ², that is n_d at 587.56 nm and has the
/// Abbe number (n_d - 1) / (n_F - n_C), F and C at 486.13 and 656.27 nm.
double cauchy_index(double n_d, double abbe, double nanometres);
/// ∫ f(λ) w(λ) dλ for red, green and blue from one wavelength in nanometres to another, within 390 to 680. w is what
/// white light of a wavelength gives linear Rec. 709 by the fits of Wyman, Sloan and Shirley (2013) to the colour
/// matching functions of CIE 1931, where that is above 0, over its integral: f = 1 is white.
Color integrate_colors(const std::function<double(double)>& f, double from = 390, double to = 680);
/// A ray through two faces of a prism of apex angle `apex`, in a plane across its edge; angles in radians.
struct PrismRay {
    double inside = 0;    ///< angle to the normal of the first face, within
    double leaves = 0;    ///< angle to the normal of the second face, outside; away from the apex
    double deviated = 0;  ///< by which the ray has turned towards the base
    double passed = 0;    ///< share of it, by Fresnel's equations
};
/// At a first face that is met at the angle `incident`, on the side of the base.
PrismRay through_prism(double apex, double incident, double eta);
/// What a camera ray sees of a surrounding white sky through a glass sphere when the path may have `depth` bounces: the
/// first meets the sphere from outside, each further one from inside, all with the same reflectance R:
/// R + (1 - R) Σ_{k=0}^{depth-2} (1 - R) R^k = 1 - (1 - R) R^(depth-1).
double glass_sphere_radiance(double cos_incident, double eta, int depth);
/// Share of the radiance behind a glass plate that passes it at normal incidence in at most `depth` bounces:
/// (1 - R)² Σ R^(2j) over 2 + 2j <= depth; (1 - R) / (1 + R) without a bound.
double slab_transmission(double eta, int depth);

// --- Filters ---------------------------------------------------------------------------------------------------

/// ∫ of the one-dimensional filter, normalised, from -radius to x.
double tent_cdf(double x, double radius);
/// Standard deviation radius / 3, shifted down to reach 0 at the radius.
double gaussian_cdf(double x, double radius);
/// Mitchell and Netravali 1988 with B = C = 1/3, stretched to `radius` (2 in the paper).
double mitchell_cdf(double x, double radius);

// --- Quadrature ------------------------------------------------------------------------------------------------

/// Gauss–Legendre with five nodes on each of `panels` equal parts.
double integrate(const std::function<double(double)>& f, double a, double b, int panels = 16);
double integrate(const std::function<double(double, double)>& f, double x0, double x1, double y0, double y1,
                 int panels = 16);

}  // namespace steradian::analytic
