// A thin hat profile: a half-cylindrical crown with a round hole, on two flat flanges. Lengths in metres.
// Mesh it with:  gmsh hat_profile.geo -2 -format msh41
SetFactory("OpenCASCADE");

radius = 0.03;         // of the crown
flange = 0.02;         // width of each flange
length = 0.16;         // along y
hole_radius = 0.010;
hole_y = 0.105;

Mesh.CharacteristicLengthMin = 0.0092;
Mesh.CharacteristicLengthMax = 0.0092;
Mesh.Algorithm = 6;    // Frontal-Delaunay: even triangles

Point(1) = {-radius - flange, 0, 0};
Point(2) = {-radius, 0, 0};
Point(3) = {0, 0, 0};
Point(4) = {0, 0, radius};
Point(5) = {radius, 0, 0};
Point(6) = {radius + flange, 0, 0};
Line(1) = {1, 2};
Circle(2) = {2, 3, 4};
Circle(3) = {4, 3, 5};
Line(4) = {5, 6};
Extrude {0, length, 0} { Curve{1, 2, 3, 4}; }

Cylinder(1) = {0, hole_y, 0, 0, 0, 2 * radius, hole_radius};
BooleanDifference{ Surface{1, 2, 3, 4}; Delete; }{ Volume{1}; Delete; }
Coherence;

eps = 1e-6;
big = 1;
left() = Surface In BoundingBox{-big, -eps, -eps, -radius + eps, length + eps, eps};
right() = Surface In BoundingBox{radius - eps, -eps, -eps, big, length + eps, eps};
crown() = Surface In BoundingBox{-radius - eps, -eps, -eps, radius + eps, length + eps, radius + eps};
clamped() = Curve In BoundingBox{-big, -eps, -eps, big, eps, big};
hole() = Curve In BoundingBox{-hole_radius - eps, hole_y - hole_radius - eps, eps,
                              hole_radius + eps, hole_y + hole_radius + eps, big};

Physical Surface("crown") = {crown()};
Physical Surface("flanges") = {left(), right()};
Physical Curve("clamped_end") = {clamped()};
Physical Curve("hole") = {hole()};
