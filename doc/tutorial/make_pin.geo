// The drawing of lesson 3 that stands for your own: writes pin.step. gmsh -0 make_pin.geo runs it, and so does a deck that names it as its mesh.
// A cylinder of radius 5 with a spherical tip of radius 20. Units: mm.
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0, 12, 5};
Sphere(2) = {0, 0, 20, 20};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Save "pin.step";
