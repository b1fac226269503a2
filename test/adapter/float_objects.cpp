// This file must not compile. The compiler's message must give the reason.
#include "fcl_stpbv/adapter/fcl_distance.h"

double ask(const fcl::CollisionObjectf& a, const fcl::CollisionObjectf& b) {
  fcl::DistanceRequestf request;
  fcl::DistanceResultf result;
  return fcl_stpbv::distance(&a, &b, request, result);
}
