// marching_cubes_peer.cpp: runs vtkMarchingCubes and vtkFlyingEdges3D.
#include "marching_cubes_peer.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace espdiff_bench {
namespace {

template <typename Filter>
PeerSurface run(const espdiff::Grid& density, float isovalue) {
  constexpr int kPeerRuns = 7;
  vtkSMPTools::Initialize(1);
  const espdiff::Lattice& lattice = density.lattice;
  vtkNew<vtkFloatArray> values;
  values->SetNumberOfValues(static_cast<vtkIdType>(density.values.size()));
  std::copy(density.values.begin(), density.values.end(), values->GetPointer(0));
  vtkNew<vtkImageData> image;
  image->SetDimensions(lattice.size[0], lattice.size[1], lattice.size[2]);
  image->SetOrigin(lattice.origin.x, lattice.origin.y, lattice.origin.z);
  image->SetSpacing(lattice.step[0].x, lattice.step[1].y, lattice.step[2].z);
  image->GetPointData()->SetScalars(values);

  vtkNew<Filter> filter;
  filter->SetInputData(image);
  filter->SetValue(0, static_cast<double>(isovalue));
  filter->ComputeNormalsOff();
  filter->ComputeGradientsOff();
  filter->ComputeScalarsOff();
  std::vector<double> times;
  for (int i = 0; i < kPeerRuns; ++i) {
    filter->Modified();
    const auto start = std::chrono::steady_clock::now();
    filter->Update();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + kPeerRuns / 2, times.end());
  vtkPolyData* surface = filter->GetOutput();
  return {static_cast<std::size_t>(surface->GetNumberOfPolys()), static_cast<std::size_t>(surface->GetNumberOfPoints()),
          times[kPeerRuns / 2]};
}

}  // namespace

PeerSurface vtk_marching_cubes(const espdiff::Grid& density, float isovalue) {
  return run<vtkMarchingCubes>(density, isovalue);
}
PeerSurface vtk_flying_edges(const espdiff::Grid& density, float isovalue) {
  return run<vtkFlyingEdges3D>(density, isovalue);
}

}  // namespace espdiff_bench
