// Writes surfaces.txt: the surfaces of pin.step and the boxes around them.
Merge "pin.step";
s() = Surface{:};
Printf("%g surfaces", #s()) > "surfaces.txt";
For i In {0 : #s() - 1}
  b() = BoundingBox Surface{s(i)};
  Printf("surface %g: from (%g, %g, %g) to (%g, %g, %g)", s(i), b(0), b(1), b(2), b(3), b(4), b(5)) >> "surfaces.txt";
EndFor
