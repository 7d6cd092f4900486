#pragma once

/// The classes of CHAI3D 3.3 that docs/chai3d.md uses, with the members that it uses, declared as
/// CHAI3D's headers declare them. The page is compiled with it; nothing is linked.
namespace chai3d {

class cVector3d {
 public:
  cVector3d() = default;
  cVector3d(double x, double y, double z);
  double& operator()(int index);
  const double& operator()(int index) const;
};
cVector3d operator-(const cVector3d& a, const cVector3d& b);

class cMatrix3d {
 public:
  cMatrix3d() = default;
  cMatrix3d(const double& m00, const double& m01, const double& m02, const double& m10,
            const double& m11, const double& m12, const double& m20, const double& m21,
            const double& m22);
  double& operator()(int row, int column);
  const double& operator()(int row, int column) const;
};
cVector3d operator*(const cMatrix3d& matrix, const cVector3d& vector);
cMatrix3d cMul(const cMatrix3d& a, const cMatrix3d& b);
cMatrix3d cTranspose(const cMatrix3d& matrix);

class cRenderOptions;

class cGenericObject {
 public:
  virtual ~cGenericObject();
  virtual void setLocalPos(const cVector3d& position);
  virtual void setLocalRot(const cMatrix3d& rotation);
  virtual void computeGlobalPositions(bool frame_only = true,
                                      const cVector3d& position = cVector3d(0.0, 0.0, 0.0),
                                      const cMatrix3d& rotation = cMatrix3d());
  virtual void renderSceneGraph(cRenderOptions& options);

 protected:
  virtual void render(cRenderOptions& options);
  cVector3d m_globalPos;
  cMatrix3d m_globalRot;
};

class cWorld : public cGenericObject {};

class cGenericTool : public cGenericObject {
 public:
  explicit cGenericTool(cWorld* world);
  virtual void updateFromDevice();
  virtual void computeInteractionForces();
  void setDeviceGlobalForce(const double& x, const double& y, const double& z);
  void setDeviceGlobalTorque(const double& x, const double& y, const double& z);
  virtual void setGripperForce(const double& force);
  bool setWorkspaceScaleFactor(const double& factor);
  void render(cRenderOptions& options) override;
  cGenericObject* m_image;

 protected:
  cVector3d m_deviceLocalPos, m_deviceGlobalPos;
  cMatrix3d m_deviceLocalRot, m_deviceGlobalRot;
  cWorld* m_parentWorld;
  virtual void updateToolImagePosition();
};

}  // namespace chai3d
