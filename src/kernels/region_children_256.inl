// The boxes of a node's eight children, eight floats wide: what the AVX2 and the AVX-512 kernel share.
// Included inside each kernel's anonymous namespace, after its
//   unsigned atMost(__m256 a, __m256 b)   bit set of the lanes where a <= b

inline __m256
nearestSquare(const RegionNode& node, const __m256 q[3])
{
  const __m256 zero = _mm256_setzero_ps();
  __m256 sum = zero;
  for (int a = 0; a < 3; ++a) {
    const __m256 d =
        _mm256_max_ps(_mm256_max_ps(_mm256_sub_ps(_mm256_loadu_ps(node.low[a]), q[a]),
                                    _mm256_sub_ps(q[a], _mm256_loadu_ps(node.high[a]))),
                      zero);
    sum = _mm256_add_ps(sum, _mm256_mul_ps(d, d)); // 0 + dx * dx is exact
  }
  return sum;
}

inline __m256
farthestSquare(const RegionNode& node, const __m256 q[3])
{
  __m256 sum = _mm256_setzero_ps();
  for (int a = 0; a < 3; ++a) {
    const __m256 d = _mm256_max_ps(_mm256_sub_ps(q[a], _mm256_loadu_ps(node.low[a])),
                                   _mm256_sub_ps(_mm256_loadu_ps(node.high[a]), q[a]));
    sum = _mm256_add_ps(sum, _mm256_mul_ps(d, d));
  }
  return sum;
}

inline void
childDistances(const RegionNode& node, const float* q, float* square)
{
  const __m256 v[3] = {_mm256_set1_ps(q[0]), _mm256_set1_ps(q[1]), _mm256_set1_ps(q[2])};
  _mm256_storeu_ps(square, nearestSquare(node, v));
}

inline unsigned
testChildren(const RegionNode& node, const RegionQuery& query, unsigned& inside)
{
  const __m256 q[3] = {_mm256_set1_ps(query.q[0]), _mm256_set1_ps(query.q[1]),
                       _mm256_set1_ps(query.q[2])};
  const __m256 square = _mm256_set1_ps(query.square);
  inside = atMost(farthestSquare(node, q), square);
  return atMost(nearestSquare(node, q), square);
}
