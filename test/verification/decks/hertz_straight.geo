// The half cylinder of input/hertz.geo with straight edges: the middle nodes lie on the chords.
Include "../../../input/hertz.geo";
Mesh.SecondOrderLinear = 1;
