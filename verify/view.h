#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cguide/exact/core/model.h"
#include "cguide/exact/core/path.h"

namespace cguide::verify {

/** X_WB in floats: p_W = R p_B + p (m). For drawing only. */
struct ViewPose {
  Eigen::Matrix3f R = Eigen::Matrix3f::Identity();
  Eigen::Vector3f p = Eigen::Vector3f::Zero();
};

/** A contact as it is drawn: a point, its normal and its friction cone. In W. */
struct ViewContact {
  int body = -1;                                        ///< index into Robot::bodies
  int object = -1;                                      ///< index into Model::objects
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();    ///< where the force acts
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< from the obstacle towards the robot
  double friction = 0;                                  ///< mu >= 0
  bool certain = true;  ///< false: it only may be active; drawn hollow
};

/** The robot at one instant of the path, with what was found out about that instant. */
struct ViewFrame {
  int edge = 0;  ///< index of the waypoint the edge starts from; 0 where the path has no edge
  double s = 0;  ///< in [0,1] along that edge
  std::vector<ViewPose> X_WB;  ///< one per body of the robot
  std::vector<ViewContact> contacts;
  Eigen::Vector3d com_W = Eigen::Vector3d::Zero();
  std::optional<double> com_margin;       ///< radius of CoM displacement that keeps stability (m)
  std::optional<double> clearance;        ///< smallest distance of any pair; negative inside (m)
  Verdict verdict = Verdict::kUndecided;  ///< of this instant alone
  std::string note;                ///< one line: what fails, or why it is undecided; may be empty
  std::vector<int> marked_bodies;  ///< drawn in the colour of a violation
  /** Corners of the region of horizontal CoM positions that keep stability, in order round it (m);
   empty where it was not computed. */
  std::vector<Eigen::Vector2d> support_W;
};

/** A line of the table of worst instants; choosing it shows the frame nearest to (edge, s). */
struct ViewInstant {
  std::string kind;  ///< "clearance", "stability", "violation" ...
  int edge = 0;
  double s = 0;
  std::string text;  ///< one line: bodies, objects, reason
  double value = 0;
  std::string unit;  ///< "m", "s"; may be empty
};

/** Everything a page shows. Plain data, SI, frames in W with z up in the picture. */
struct ViewInput {
  std::string title;
  /** Label and text of each line of provenance: files, digests, seed, version. */
  std::vector<std::pair<std::string, std::string>> provenance;
  std::string tested;                     ///< how the verdicts came about: "sampled(0.01)"
  Verdict verdict = Verdict::kUndecided;  ///< of the guide as a whole
  std::string summary;                    ///< one or two sentences under the verdict
  /** For each edge: a proof that all of it, for every s, is in C_guide has been accepted. Empty
   where there is no certificate: then the page does not speak of proofs. */
  std::vector<bool> proved_edges;
  Model model;
  Path path;
  std::vector<ViewFrame> frames;   ///< ordered by (edge, s); at least one
  std::vector<ViewInstant> worst;  ///< the worst first
};

/** One HTML file that needs nothing else: it makes no request to the network, its scripts and data
 are inside.

 Shown are the verdict, the provenance and the worst instants (also where scripts do not run), the
 animation in 3-D (WebGL, or else a flat drawing in SVG), and a timeline. The path's time is its
 length in the metric of core's Distance, scaled to [0,1]. Fragments of the address choose what is
 seen first: `#t=0.5` (instant), `#view=front|side|top|iso`, `#ghosts=1`, `#xray=1`, `#cones=0`,
 `#trail=0`, `#play=1`, joined by `&`. The attributes of the document's root element tell a program
 what is drawn: data-ready, data-t, data-frame, data-frames, data-edge, data-s, data-verdict,
 data-view, data-renderer, data-errors.

 Texts of the input are shown as text whatever characters they hold; bytes that are not UTF-8 become
 U+FFFD. The same input gives the same bytes.

 Not promised: that the drawing between two frames is where the robot is (each body is interpolated
 on its own). Where all edges are proved the verdict is "proved", unless it was given as one that
 fails; proved edges are underlined in the timeline. The page repeats the verdicts it is given and
 decides nothing.

 @throws Error (kInvalidArgument) where there is no frame, proved_edges are not as many as edges,
 frames are out of order or off the path, a frame has the wrong number of poses, an index is out of
 range, or a pose, contact, support corner or centre of mass is not finite. */
std::string RenderPage(const ViewInput& input);

}  // namespace cguide::verify
