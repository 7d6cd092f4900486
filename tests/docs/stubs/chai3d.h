#pragma once

#include <limits>
#include <memory>
#include <vector>

/// The classes of CHAI3D 3.3 that docs/chai3d.md and its test use, with the members that they use,
/// declared as CHAI3D's headers declare them. Each does here what CHAI3D says of it; nothing is
/// drawn.
namespace chai3d {

class cVector3d {
 public:
  cVector3d() = default;
  cVector3d(double x, double y, double z) : values_{x, y, z} {}
  double& operator()(int index) { return values_[index]; }
  const double& operator()(int index) const { return values_[index]; }

 private:
  static constexpr double kUnset =
      std::numeric_limits<double>::quiet_NaN();  // CHAI3D leaves it open
  double values_[3] = {kUnset, kUnset, kUnset};
};

inline cVector3d operator+(const cVector3d& a, const cVector3d& b) {
  return {a(0) + b(0), a(1) + b(1), a(2) + b(2)};
}
inline cVector3d operator-(const cVector3d& a, const cVector3d& b) {
  return {a(0) - b(0), a(1) - b(1), a(2) - b(2)};
}
inline cVector3d operator*(const double factor, const cVector3d& a) {
  return {factor * a(0), factor * a(1), factor * a(2)};
}

class cMatrix3d {
 public:
  cMatrix3d() = default;
  cMatrix3d(const double& m00, const double& m01, const double& m02, const double& m10,
            const double& m11, const double& m12, const double& m20, const double& m21,
            const double& m22)
      : rows_{{m00, m01, m02}, {m10, m11, m12}, {m20, m21, m22}} {}
  double& operator()(int row, int column) { return rows_[row](column); }
  const double& operator()(int row, int column) const { return rows_[row](column); }

 private:
  cVector3d rows_[3];
};

inline cVector3d operator*(const cMatrix3d& matrix, const cVector3d& vector) {
  cVector3d product;
  for (int i = 0; i < 3; ++i) {
    product(i) = matrix(i, 0) * vector(0) + matrix(i, 1) * vector(1) + matrix(i, 2) * vector(2);
  }
  return product;
}
inline cMatrix3d cMul(const cMatrix3d& a, const cMatrix3d& b) {
  cMatrix3d product;
  for (int j = 0; j < 3; ++j) {
    const cVector3d column = a * cVector3d(b(0, j), b(1, j), b(2, j));
    for (int i = 0; i < 3; ++i) product(i, j) = column(i);
  }
  return product;
}
inline cMatrix3d cTranspose(const cMatrix3d& m) {
  return {m(0, 0), m(1, 0), m(2, 0), m(0, 1), m(1, 1), m(2, 1), m(0, 2), m(1, 2), m(2, 2)};
}
inline cMatrix3d cIdentity3d() { return {1, 0, 0, 0, 1, 0, 0, 0, 1}; }

class cRenderOptions;

class cGenericObject {
 public:
  cGenericObject() = default;
  cGenericObject(const cGenericObject&) = delete;
  cGenericObject& operator=(const cGenericObject&) = delete;
  virtual ~cGenericObject() {
    for (const cGenericObject* child : m_children) delete child;
  }
  virtual bool addChild(cGenericObject* object) {
    m_children.push_back(object);
    return true;
  }
  virtual void setLocalPos(const cVector3d& position) { m_localPos = position; }
  virtual void setLocalRot(const cMatrix3d& rotation) { m_localRot = rotation; }
  cVector3d getGlobalPos() const { return m_globalPos; }
  cMatrix3d getGlobalRot() const { return m_globalRot; }
  virtual void computeGlobalPositions(const bool frame_only = true,
                                      const cVector3d& position = cVector3d(0.0, 0.0, 0.0),
                                      const cMatrix3d& rotation = cIdentity3d()) {
    m_globalPos = position + rotation * m_localPos;
    m_globalRot = cMul(rotation, m_localRot);
    updateGlobalPositions(frame_only);
    for (cGenericObject* child : m_children) {
      child->computeGlobalPositions(frame_only, m_globalPos, m_globalRot);
    }
  }
  virtual void renderSceneGraph(cRenderOptions& options) { render(options); }

 protected:
  virtual void render(cRenderOptions& /*options*/) {}
  virtual void updateGlobalPositions(const bool /*frame_only*/) {}
  std::vector<cGenericObject*> m_children;
  cVector3d m_localPos{0, 0, 0}, m_globalPos{0, 0, 0};
  cMatrix3d m_localRot = cIdentity3d(), m_globalRot = cIdentity3d();
};

class cWorld : public cGenericObject {};

class cGenericHapticDevice {
 public:
  virtual ~cGenericHapticDevice() = default;
  virtual bool open() { return false; }
  virtual bool close() { return false; }
  virtual bool calibrate(bool /*force_calibration*/ = false) { return false; }
  virtual bool getPosition(cVector3d& position) {
    position = cVector3d(0, 0, 0);
    return false;
  }
  virtual bool getRotation(cMatrix3d& rotation) {
    rotation = cIdentity3d();
    return false;
  }
  virtual bool setForceAndTorqueAndGripperForce(const cVector3d& /*force*/,
                                                const cVector3d& /*torque*/,
                                                const double /*gripper_force*/) {
    return false;
  }
};
using cGenericHapticDevicePtr = std::shared_ptr<cGenericHapticDevice>;

class cGenericTool : public cGenericObject {
 public:
  explicit cGenericTool(cWorld* world) : m_image(new cGenericObject), m_parentWorld(world) {}
  ~cGenericTool() override { delete m_image; }
  void setHapticDevice(cGenericHapticDevicePtr device) { m_hapticDevice = device; }
  virtual bool start() {
    m_enabled = m_hapticDevice != nullptr && m_hapticDevice->open();
    if (m_enabled) m_hapticDevice->calibrate(false);
    updateFromDevice();
    return m_enabled;
  }
  virtual bool stop() { return m_enabled && m_hapticDevice->close(); }
  virtual void updateFromDevice() {
    if (!m_enabled) return;
    cVector3d position(0, 0, 0);
    m_hapticDevice->getPosition(position);
    m_hapticDevice->getRotation(m_deviceLocalRot);
    m_deviceLocalPos = m_workspaceScaleFactor * position;
    m_deviceGlobalPos = m_globalPos + m_globalRot * m_deviceLocalPos;
    m_deviceGlobalRot = cMul(m_globalRot, m_deviceLocalRot);
    updateToolImagePosition();
  }
  virtual void computeInteractionForces() {}
  virtual bool applyToDevice() {
    return m_enabled && m_hapticDevice->setForceAndTorqueAndGripperForce(
                            m_deviceLocalForce, m_deviceLocalTorque, m_gripperForce);
  }
  void setDeviceGlobalForce(const double& x, const double& y, const double& z) {
    m_deviceLocalForce = cTranspose(m_globalRot) * cVector3d(x, y, z);
  }
  void setDeviceGlobalTorque(const double& x, const double& y, const double& z) {
    m_deviceLocalTorque = cTranspose(m_globalRot) * cVector3d(x, y, z);
  }
  virtual void setGripperForce(const double& force) { m_gripperForce = force; }
  virtual cVector3d getDeviceGlobalPos() const { return m_deviceGlobalPos; }
  bool setWorkspaceScaleFactor(const double& factor) {
    if (m_hapticDevice == nullptr || factor == 0) return false;
    m_workspaceScaleFactor = factor < 0 ? -factor : factor;
    updateFromDevice();
    return true;
  }
  void render(cRenderOptions& /*options*/) override {}
  cGenericObject* m_image;

 protected:
  cGenericHapticDevicePtr m_hapticDevice;
  bool m_enabled = false;
  double m_workspaceScaleFactor = 1, m_gripperForce = 0;
  cVector3d m_deviceLocalForce{0, 0, 0}, m_deviceLocalTorque{0, 0, 0};
  cVector3d m_deviceLocalPos{0, 0, 0}, m_deviceGlobalPos{0, 0, 0};
  cMatrix3d m_deviceLocalRot = cIdentity3d(), m_deviceGlobalRot = cIdentity3d();
  cWorld* m_parentWorld;
  virtual void updateToolImagePosition() {
    m_image->setLocalPos(m_deviceLocalPos);
    m_image->setLocalRot(m_deviceLocalRot);
  }
  void updateGlobalPositions(const bool frame_only) override {
    m_image->computeGlobalPositions(frame_only, m_globalPos, m_globalRot);
  }
};

}  // namespace chai3d
