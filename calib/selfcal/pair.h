// What the common points of two stations say before anything is known of their lenses.
#pragma once

#include "calib/selfcal/tracks.h"

#include <array>
#include <vector>

namespace laterna {

/// The points that two stations share.
struct StationPair {
  int a = 0, b = 0;  ///< stations, a < b
  std::vector<int> points;
  std::vector<glm::dvec2> pixel_a, pixel_b;
  std::vector<double> sigma_a, sigma_b;

  std::size_t size() const { return points.size(); }
};

/// All pairs of stations with at least 8 points in common, by a, then b.
std::vector<StationPair> station_pairs(const Tracks& tracks);

/// Hartley's normaliser: N·(u, v, 1) has its centroid at the origin and lies √2 from it in the mean; N keeps
/// axes and aspect. Coinciding pixels are scaled by √2·10¹². (Hartley and Zisserman, Multiple View Geometry,
/// 2nd ed., 4.4.4)
glm::dmat3 normalised_from_pixel(const std::vector<glm::dvec2>& pixels);

/// Sampson's distance of each point from a fundamental matrix (x_bᵀ·F·x_a = 0), in sigmas: r =
/// x_bᵀF x_a / sqrt(σ_b²·|(F x_a)₁₂|² + σ_a²·|(Fᵀx_b)₁₂|²). (Hartley and Zisserman, 11.4.3)
std::vector<double> epipolar_residuals(const StationPair& pair, const glm::dmat3& fundamental);

struct PairGeometry {
  glm::dmat3 fundamental{0.0};  ///< maximum likelihood (Sampson) of the inliers; Frobenius norm 1
  std::vector<char> inlier;     ///< of each of the pair's points
  std::size_t inliers = 0;
  double epipolar_scale = 0;    ///< rms of the inliers' residuals: 1 where the noise is as stated
  double homography_scale = 0;  ///< the same for the best homography, two coordinates a point
  /// A homography explains the inliers as well: the scene is a plane, or the device only turned. By Torr's
  /// GRIC (Torr, Int. J. Computer Vision 50, 2002), Σ min(e²/σ², 2(4 - d)) + d·n·ln 4 + k·ln(4n), with d = 2,
  /// k = 8 for a homography and d = 3, k = 7 for a fundamental matrix, and σ² the larger of the stated and
  /// the fundamental matrix's: relief below some 1.2 sigma counts as a plane.
  bool homography_explains = false;
  glm::dmat3 homography{1.0};  ///< x_b = H·x_a
};

/// OpenCV's USAC, then least squares on Sampson's distance with inliers chosen anew (within 4 times the
/// robust scale, at least 4 sigma). Refusal where no matrix is found, or it has fewer than 8 inliers.
PairGeometry pair_geometry(const StationPair& pair);

/// Fits a homography alone to all points of a pair, rms in sigmas as in PairGeometry.
double fit_homography(const StationPair& pair, glm::dmat3& homography);

/// The points of a pair that a mask keeps.
StationPair kept(const StationPair& pair, const std::vector<char>& keep);

/// f² of station a's device from a fundamental matrix when both principal points are known (Bougnoux 1998):
///   f_a² = - (p_bᵀ[e_b]×ĨF p_a)(p_aᵀFᵀp_b) / (p_bᵀ[e_b]×ĨFĨFᵀp_b),  Ĩ = diag(1, 1, 0),
/// and of b by exchanging the two. Not positive, or meaningless, where the optical axes meet: there
/// p_bᵀ·F·p_a = 0.
std::array<double, 2> squared_focal_lengths(const glm::dmat3& fundamental, const glm::dvec2& center_a,
                                            const glm::dvec2& center_b);

/// How far the optical axes of a pair miss each other, as the images see it: the distance of center_b from
/// the epipolar line of center_a and of center_a from that of center_b, in pixels, the smaller.
double axes_miss_px(const glm::dmat3& fundamental, const glm::dvec2& center_a, const glm::dvec2& center_b);

}  // namespace laterna
