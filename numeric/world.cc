#include "cguide/numeric/world.h"

#include "cguide/numeric/geometry_internal.h"

namespace cguide::numeric {
namespace {

Model Checked(Model model) {
  CheckModel(model);
  return model;
}

void PlaceShape(const BodyShape& shape, const KinematicState& state, Convex* placed) {
  const Transform& X_WB = state.X_WB[shape.body];
  placed->c = X_WB * shape.local.c;
  placed->R = X_WB.R * shape.local.R;
  placed->error = PlacementError(state.error_R[shape.body], state.error_p[shape.body], shape.L,
                                 placed->c.lpNorm<1>());
}

}  // namespace

World::World(Model model)
    : model_(Checked(std::move(model))),
      tree_(model_.robot),
      geometry_(std::make_unique<Geometry>(model_)) {}

World::~World() = default;

Workspace::Workspace(const World& world) : scratch(std::make_unique<Scratch>()) {
  const Geometry& geometry = world.geometry();
  for (const BodyShape& shape : geometry.shapes) scratch->shapes.push_back(shape.local);
  scratch->centers.resize(geometry.num_bodies);
  scratch->radii.assign(geometry.num_bodies, -1);
  scratch->hints.resize(geometry.num_hints);
}

Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

void Place(const World& world, const Configuration& q, Workspace* workspace) {
  ForwardKinematics(world.tree(), q, &workspace->state);
  PlaceFromState(world, workspace);
}

void PlaceFromState(const World& world, Workspace* workspace) {
  const Geometry& geometry = world.geometry();
  const KinematicState& state = workspace->state;
  Workspace::Scratch& scratch = *workspace->scratch;
  for (std::size_t i = 0; i < geometry.shapes.size(); ++i) {
    PlaceShape(geometry.shapes[i], state, &scratch.shapes[i]);
  }
  for (int body = 0; body < geometry.num_bodies; ++body) {
    if (geometry.body_begin[body] == geometry.body_begin[body + 1]) continue;
    const BodyBall& ball = geometry.body_balls[body];
    const double L = ball.c_B.norm() + ball.radius;
    scratch.centers[body] = state.X_WB[body] * ball.c_B;
    scratch.radii[body] = ball.radius + PlacementError(state.error_R[body], state.error_p[body], L,
                                                       scratch.centers[body].lpNorm<1>());
  }
}

}  // namespace cguide::numeric
