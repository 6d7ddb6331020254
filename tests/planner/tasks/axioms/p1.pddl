(define (problem mend-and-light) (:domain power)
  (:objects s a b c d - node)
  (:init (source s) (wire s a) (wire a b) (wire b c) (wire c d) (wire s d) (closed s a) (closed a b) (closed s d))
  (:goal (and (mended b) (mended d) (forall (?x - node) (live ?x)))))
