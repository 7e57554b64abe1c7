// Names for the faces of pin.step, and the size of cells. Units: mm.
Merge "pin.step";

Physical Volume("pin") = {1};
Physical Surface("top") = Surface In BoundingBox {-6, -6, 11.9, 6, 6, 12.1};
Physical Surface("tip") = Surface In BoundingBox {-6, -6, -0.1, 6, 6, 1};

// Cells of 0.25 within 0.8 of the point that touches first, growing to 3.
Field[1] = Ball;
Field[1].Radius = 0.8;
Field[1].Thickness = 8;
Field[1].VIn = 0.25;
Field[1].VOut = 3;
Background Field = 1;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
